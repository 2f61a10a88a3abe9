#include "datasets/evaluation/limits_verb.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <stdexcept>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "datasets/evaluation/decoder_limits.h"
#include "datasets/evaluation/experiment.h"
#include "datasets/evaluation/named_weights.h"
#include "datasets/evaluation/picture_sheet.h"
#include "datasets/synth/material_source.h"
#include "fitting/weights/find_model.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr int kOwnMaterials = 8;

struct LimitsOptions {
  std::vector<std::string> materials, weights;
  fs::path work;
  int size = 256, iterations = 200;
};

struct Network {
  std::string name;
  Autoencoder autoencoder;
};

std::vector<Network> LoadNetworks(const std::vector<std::string>& texts) {
  std::vector<Network> networks;
  try {
    if (texts.empty()) {
      networks.push_back({"shipped", Autoencoder::Load(FindModel(kAutoencoderModel))});
    }
    for (const auto& [name, file] : ReadNamedWeights(texts)) {
      networks.push_back({name, Autoencoder::Load(file)});
    }
  } catch (const UserError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw UserError(error.what());
  }
  return networks;
}

// Figures by material, and their means, by what the maps were made with.
class Table {
 public:
  void Add(const std::string& material, const std::string& made, const LimitFigures& figures) {
    rows_.push_back({material, made, figures});
  }

  // The means, in the order in which what they were made with first came.
  Table Means() const {
    Table means;
    for (const Row& row : rows_) {
      if (means.Find(row.made) != nullptr) continue;
      means.Add("mean", row.made, Mean(row.made));
    }
    return means;
  }

  static const char* CsvHeading() {
    return "material,maps,diffuse,specular,roughness,normal,map_average,render,detail,agreement\n";
  }

  std::string CsvLines() const {
    std::string text;
    for (const Row& row : rows_) {
      text += row.material + "," + row.made;
      for (const double value : Values(row.figures)) text += fmt::format(",{:.8g}", value);
      text += "\n";
    }
    return text;
  }

  std::string Markdown() const {
    std::string text =
        "| maps | diffuse | specular | roughness | normal | map average | render | detail | "
        "agreement |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for (const Row& row : rows_) {
      const auto v = Values(row.figures);
      text += "| " + row.made + " |";
      for (size_t i = 0; i < v.size(); ++i) text += fmt::format(" {:.{}f} |", v[i], i < 6 ? 6 : 3);
      text += "\n";
    }
    return text;
  }

  Json ToJson() const {
    Json json = Json::array();
    for (const Row& row : rows_) {
      json.push_back({{"material", row.material},
                      {"maps", row.made},
                      {"errors", ErrorsJson(row.figures.errors)},
                      {"detail", row.figures.detail.energy},
                      {"agreement", row.figures.detail.agreement}});
    }
    return json;
  }

 private:
  struct Row {
    std::string material, made;
    LimitFigures figures;
  };

  static std::array<double, 8> Values(const LimitFigures& f) {
    const MapErrors& maps = f.errors.maps;
    return {maps.diffuse,   maps.specular,   maps.roughness,  maps.normal,
            maps.average(), f.errors.render, f.detail.energy, f.detail.agreement};
  }

  const Row* Find(const std::string& made) const {
    for (const Row& row : rows_) {
      if (row.made == made) return &row;
    }
    return nullptr;
  }

  LimitFigures Mean(const std::string& made) const {
    LimitFigures mean;
    int count = 0;
    for (const Row& row : rows_) count += row.made == made;
    for (const Row& row : rows_) {
      if (row.made != made) continue;
      const MapErrors& maps = row.figures.errors.maps;
      mean.errors.maps.diffuse += maps.diffuse / count;
      mean.errors.maps.specular += maps.specular / count;
      mean.errors.maps.roughness += maps.roughness / count;
      mean.errors.maps.normal += maps.normal / count;
      mean.errors.render += row.figures.errors.render / count;
      mean.detail.energy += row.figures.detail.energy / count;
      mean.detail.agreement += row.figures.detail.agreement / count;
    }
    return mean;
  }

  std::vector<Row> rows_;
};

ProgramResult Measure(const LimitsOptions& options, int threads) {
  const std::vector<Network> networks = LoadNetworks(options.weights);
  const std::vector<std::string> materials = options.materials.empty()
                                                 ? ReservedMaterials(kOwnMaterials)
                                                 : ExpandMaterials(options.materials);
  Table table;
  std::vector<SheetBlock> blocks;
  for (const std::string& text : materials) {
    const MaterialSource material = LoadMaterial(text, options.size);
    SheetBlock block{material.name, {{"truth", material.maps}}};
    const auto take = [&](const std::string& made, const SvbrdfMaps& maps) {
      const LimitFigures figures = MeasureAgainst(maps, material.maps, threads);
      table.Add(material.name, made, figures);
      block.lines.emplace_back(made, maps);
      spdlog::info("{} {}: map average {:.6f}, render {:.6f}", material.name, made,
                   figures.errors.maps.average(), figures.errors.render);
    };
    for (const auto& [name, network] : networks) {
      take(name + "-encoded", EncodedAndDecoded(network, material.maps, threads));
      if (options.iterations == 0) continue;
      take(name + "-fitted", CodeFittedToMaps(network, material.maps, options.iterations, threads));
    }
    if (std::ssize(blocks) < kSheetMaterials) blocks.push_back(std::move(block));
  }
  const Table means = table.Means();
  const Json json = {{"means", means.ToJson()}, {"entries", table.ToJson()}};
  fs::create_directories(options.work);
  WriteFileAtomically(options.work / "limits.csv",
                      Table::CsvHeading() + table.CsvLines() + means.CsvLines());
  WriteFileAtomically(options.work / "limits.json", json.dump(2) + "\n");
  WritePng(options.work / "limits.png", DrawBlocks(blocks, threads));
  return {means.Markdown(), json};
}

int RunLimits(int argc, char** argv, const ProgramInfo& info) {
  LimitsOptions limits;
  OptionSet options;
  options.AddPositional("materials", &limits.materials, "as in glint-eval table1", false);
  options.Add("weights", &limits.weights,
              "NAME=FILE of each auto-encoder (default: the shipped one)");
  options.Add("work", &limits.work, "folder for the results (required)");
  options.AddRange("size", &limits.size, 8, 4096, "texels per side");
  options.AddRange(
      "iterations", &limits.iterations, 0, 1e6,
      "maximum number of steps when fitting a code to the maps; 0: only encode and decode");
  return RunProgram(argc, argv, info, &options, [&](const CommonOptions& common) {
    if (limits.work.empty()) throw UserError("work: found nothing; name a folder for the results");
    if (common.check) throw UserError("status: a measurement is not a stage; leave the option out");
    return Measure(limits, common.threads);
  });
}

}  // namespace

Verb LimitsVerb() {
  return {"limits",
          "Measures how well auto-encoders represent materials: errors in maps after encoding and "
          "decoding, and in maps decoded from codes fitted to the maps.",
          "Example: glint-eval limits procedural:1000000000 --work /tmp/limits", RunLimits};
}

}  // namespace glint
