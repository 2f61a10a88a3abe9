#include "datasets/evaluation/relight_verb.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/rectified_set.h"
#include "base/images/image.h"
#include "base/stages/stages.h"
#include "datasets/evaluation/held_out_views.h"
#include "datasets/evaluation/light_interpolation.h"
#include "datasets/looks/looks_figures.h"
#include "datasets/looks/view_error.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct RelightFigures {
  double log_l1 = 0, psnr_db = 0;
  Looks looks;
};

struct RelightRow {
  std::string set, method;
  RelightFigures figures;
};

constexpr double kGamma = 2.2;

// Peak signal-to-noise ratio of values as a screen shows them.
double Psnr_db(const std::vector<float>& rendered, const RectifiedImage& photograph) {
  const size_t texels = photograph.mask.size();
  double squares = 0, count = 0;
  for (size_t i = 0; i < rendered.size(); ++i) {
    if (photograph.mask[i % texels] < 0.5f) continue;
    const auto shown = [](float value) {
      return std::pow(std::clamp(value, 0.0f, 1.0f), 1 / kGamma);
    };
    squares += std::pow(shown(rendered[i]) - shown(photograph.rgb[i]), 2);
    count += 1;
  }
  return squares > 0 ? 10 * std::log10(count / squares) : 0;
}

// Held-out photographs of one set, and the others, with what was found of their lights.
class RelitSet {
 public:
  RelitSet(const HoldoutEntry& entry, int threads)
      : fit_(ReadFittedMaps(entry.manifest)),
        set_(ReadRectifiedSet(entry.views)),
        threads_(threads) {
    for (const RectifiedView& view : set_.views) {
      const bool out = std::find(entry.held_out_names.begin(), entry.held_out_names.end(),
                                 view.name) != entry.held_out_names.end();
      (out ? wanted_ : known_).push_back(view);
    }
    for (const RectifiedView& view : wanted_) {
      photographs_.push_back(PhotographOfFit(fit_, set_, view));
    }
  }

  // By the maps; then by each interpolation, of photographs as they are and as if under lamps of
  // the strengths that were found.
  std::vector<RelightRow> Compare(const std::string& name, const fs::path& pairs) {
    std::vector<RelightRow> rows;
    std::vector<std::vector<float>> rendered;
    for (const RectifiedView& view : wanted_) {
      rendered.push_back(RenderFit(fit_, set_, view, threads_));
    }
    rows.push_back({name, "maps", FiguresOf(rendered, pairs / "maps")});
    for (const bool calibrated : {false, true}) {
      LoadKnown(calibrated);
      for (const LightInterpolation& method : LightInterpolations()) {
        const std::string label = method.name + (calibrated ? ", lamps calibrated" : "");
        rows.push_back(
            {name, label, FiguresOf(Interpolated(method, calibrated), pairs / FileNameOf(label))});
      }
    }
    return rows;
  }

 private:
  static Eigen::Vector3d Direction(const RectifiedView& view) {
    return Eigen::Vector3d(view.view.light_in_sample_mm.data()).normalized();
  }
  static std::vector<Eigen::Vector3d> Directions(const std::vector<RectifiedView>& views) {
    std::vector<Eigen::Vector3d> directions;
    directions.reserve(views.size());
    for (const RectifiedView& view : views) directions.push_back(Direction(view));
    return directions;
  }
  double Exposure(const RectifiedView& view) const { return ViewOfFit(fit_, view).exposure; }

  void LoadKnown(bool calibrated) {
    encoded_.clear();
    for (const RectifiedView& view : known_) {
      RectifiedImage photograph = ReadRectifiedImage(set_, view);
      const float factor = calibrated ? static_cast<float>(1 / Exposure(view)) : 1;
      for (float& value : photograph.rgb) {
        value = std::pow(std::max(value * factor, 0.0f), static_cast<float>(1 / kGamma));
      }
      encoded_.push_back(std::move(photograph.rgb));
    }
  }

  std::vector<std::vector<float>> Interpolated(const LightInterpolation& method, bool calibrated) {
    const Eigen::MatrixXd weights = method.weights(Directions(known_), Directions(wanted_));
    std::vector<std::vector<float>> pictures;
    for (size_t w = 0; w < wanted_.size(); ++w) {
      std::vector<float> picture(encoded_[0].size(), 0.0f);
      for (size_t k = 0; k < known_.size(); ++k) {
        const auto weight =
            static_cast<float>(weights(static_cast<Eigen::Index>(w), static_cast<Eigen::Index>(k)));
        for (size_t i = 0; i < picture.size(); ++i) picture[i] += weight * encoded_[k][i];
      }
      const float factor = calibrated ? static_cast<float>(Exposure(wanted_[w])) : 1;
      for (float& value : picture) {
        value = factor * std::pow(std::max(value, 0.0f), static_cast<float>(kGamma));
      }
      pictures.push_back(std::move(picture));
    }
    return pictures;
  }

  // `pairs`: a folder for pictures; its parent's absence asks for none.
  RelightFigures FiguresOf(const std::vector<std::vector<float>>& rendered,
                           const fs::path& pairs) const {
    RelightFigures figures;
    std::vector<Looks> looks;
    const auto n = static_cast<double>(wanted_.size());
    const bool draws = !pairs.parent_path().empty();
    if (draws) fs::create_directories(pairs);
    for (size_t w = 0; w < wanted_.size(); ++w) {
      const bool ldr = wanted_[w].ldr;
      figures.log_l1 += CompareView(rendered[w], photographs_[w], ldr).log_l1 / n;
      figures.psnr_db += Psnr_db(rendered[w], photographs_[w]) / n;
      looks.push_back(CompareLooks(rendered[w], photographs_[w], ldr));
      if (draws) {
        WritePair(pairs / (wanted_[w].name + ".png"), photographs_[w], ldr, rendered[w]);
      }
    }
    figures.looks = MeanLooks(looks);
    return figures;
  }

  FittedMaps fit_;
  RectifiedSet set_;
  int threads_;
  std::vector<RectifiedView> known_, wanted_;
  std::vector<RectifiedImage> photographs_;  // of the wanted
  std::vector<std::vector<float>> encoded_;  // of the known
};

// Each `every`-th photograph, from the `first`-th on.
HoldoutSplit EveryNth(size_t photographs, int every, int first) {
  HoldoutSplit split;
  split.name = fmt::format("1 in {} held out, from {}", every, first);
  split.folder = fmt::format("each_{}_from_{}", every, first);
  for (size_t i = static_cast<size_t>(first); i < photographs; i += static_cast<size_t>(every)) {
    split.listed.push_back(std::to_string(i));
  }
  return split;
}

// Those that judge whole pictures come first.
std::vector<LooksFigure> TableFigures() {
  const auto all = LooksFigures();
  std::vector<LooksFigure> figures(all.begin(), all.end());
  std::stable_partition(figures.begin(), figures.end(),
                        [](const LooksFigure& figure) { return figure.overall; });
  return figures;
}

// One cell for a figure's bands: "contrast 1–2, 2–4".
std::string LooksHeadCell(const LooksFigure& figure) {
  std::string bands;
  for (const LooksBand& band : figure.bands.first(std::min(figure.bands.size(), kFineBands))) {
    bands += (bands.empty() ? " " : ", ") + std::string(band.heading);
  }
  return fmt::format(" {}{} |", figure.heading, bands);
}

std::string LooksCell(const LooksFigure& figure, const Looks& looks) {
  std::string text;
  for (const LooksColumn& column : ColumnsOf(figure, kFineBands)) {
    text += " " + LooksText(column.ValueOf(looks), figure.overall ? 3 : 2);
  }
  return text + " |";
}

std::string TableText(const std::vector<RelightRow>& rows) {
  const std::vector<LooksFigure> figures = TableFigures();
  std::string text = "| set | relit by | log-L1 | PSNR, dB |", rule = "|---|---|---:|---:|";
  for (const LooksFigure& figure : figures) {
    text += LooksHeadCell(figure);
    rule += figure.bands.empty() ? "---:|" : "---|";
  }
  text += "\n" + rule + "\n";
  for (const RelightRow& row : rows) {
    text += fmt::format("| {} | {} | {:.3f} | {:.1f} |", row.set, row.method, row.figures.log_l1,
                        row.figures.psnr_db);
    for (const LooksFigure& figure : figures) text += LooksCell(figure, row.figures.looks);
    text += "\n";
  }
  return text;
}

Json JsonOf(const std::vector<RelightRow>& rows) {
  Json list = Json::array();
  for (const RelightRow& row : rows) {
    Json json = {{"set", row.set},
                 {"method", row.method},
                 {"log_l1", row.figures.log_l1},
                 {"psnr_db", row.figures.psnr_db}};
    json["looks"] = ToJson(row.figures.looks);
    list.push_back(json);
  }
  return list;
}

// Photographs of the set's rectified views.
size_t PhotographsOf(const fs::path& set) {
  const fs::path file = ViewsManifest(set / "glint");
  if (!fs::exists(file)) {
    throw UserError(set, "", "no rectified views",
                    fmt::format("run first: glint run {} --until {}", set.string(),
                                LastGiving(Gives::kViews)->name));
  }
  return ReadRectifiedSet(file).views.size();
}

int RunRelight(int argc, char** argv, const ProgramInfo& info) {
  std::vector<std::string> sets, fit_arguments, refine_arguments;
  fs::path work;
  int every = 4, first = 3;
  bool pairs = false;
  OptionSet options;
  options.AddPositional("captures", &sets, "rectified captures taken with a fixed camera", true);
  options.Add("work", &work, "folder in which captures and results are kept (required)");
  options.AddRange("every", &every, 2, 1000, "hold out every Nth photograph");
  options.AddRange("first", &first, 0, 999, "index of the first held-out photograph, from 0");
  options.Add("pairs", &pairs,
              "also write pictures for every method: photograph, rendering, 4 × difference");
  options.Add("fit-args", &fit_arguments, "additional arguments for glint-fit, comma-separated");
  options.Add("refine-args", &refine_arguments,
              "additional arguments for glint-refine, comma-separated");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (common.check) throw UserError("status: an experiment is not a stage; leave the option out");
    if (work.empty()) throw UserError("--work: found nothing; name a folder for the results");
    if (first >= every) {
      throw UserError(fmt::format("--first: found {}; give less than --every ({})", first, every));
    }
    std::vector<RelightRow> rows;
    for (const std::string& set : sets) {
      HoldoutExperiment experiment;
      experiment.sets = {set};
      experiment.splits = {EveryNth(PhotographsOf(set), every, first)};
      experiment.methods = {"refined"};
      experiment.programs = {};
      experiment.fit_arguments = fit_arguments;
      experiment.refine_arguments = refine_arguments;
      experiment.work = work;
      const HoldoutResult result =
          RunHoldout(experiment, common, [](const std::string& text) { spdlog::info("{}", text); });
      const HoldoutEntry& entry = result.entries.at(0);
      const fs::path pictures =
          pairs ? work / entry.set / experiment.splits[0].folder / "pairs" : fs::path();
      for (RelightRow& row : RelitSet(entry, common.threads).Compare(entry.set, pictures)) {
        rows.push_back(std::move(row));
      }
    }
    const std::string text = TableText(rows);
    WriteFileAtomically(work / "relight.md", text);
    WriteFileAtomically(work / "relight.json", JsonOf(rows).dump(2) + "\n");
    return ProgramResult{text, JsonOf(rows)};
  });
}

}  // namespace

Verb RelightVerb() {
  return {"relight",
          "Fits maps to some photographs from a fixed camera and compares renderings under the "
          "held-out lights with interpolations of the photographs: polynomial texture maps, "
          "spherical harmonics, radial basis functions.",
          "Example: glint-eval relight icon door --work relit", RunRelight};
}

}  // namespace glint
