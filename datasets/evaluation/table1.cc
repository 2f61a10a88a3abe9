#include "datasets/evaluation/table1.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "datasets/evaluation/subprocess.h"
#include "datasets/evaluation/view_error.h"
#include "pipeline/contract/errors.h"
#include "pipeline/contract/files.h"
#include "pipeline/contract/svbrdf_file.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 6> kColumns{"diffuse", "specular",    "roughness",
                                              "normal",  "map_average", "render"};

std::array<double, 6> Figures(const Table1Row& row) {
  return {row.maps.diffuse, row.maps.specular,  row.maps.roughness,
          row.maps.normal,  row.maps.average(), row.render};
}

Json JsonOf(const Table1Row& row) {
  Json json;
  const auto figures = Figures(row);
  for (size_t i = 0; i < figures.size(); ++i) json[kColumns[i]] = figures[i];
  return json;
}

Table1Row RowOf(const fs::path& file, const Json& json) {
  Table1Row row;
  row.maps.diffuse = RequireNumber(file, json, "errors", "diffuse");
  row.maps.specular = RequireNumber(file, json, "errors", "specular");
  row.maps.roughness = RequireNumber(file, json, "errors", "roughness");
  row.maps.normal = RequireNumber(file, json, "errors", "normal");
  row.render = RequireNumber(file, json, "errors", "render");
  return row;
}

// The runs for one material and number of views.
class Experiment {
 public:
  Experiment(const Table1Options& options, const CommonOptions& common,
             const MaterialSource& material, int count)
      : options_(options),
        common_(common),
        material_(material),
        views_(options.views),
        folder_(options.work / material.name / fmt::format("n{:02}", count)) {
    views_.count = count;
  }

  // The errors of `method`, from the kept result when there is one.
  Table1Row Evaluate(const std::string& method, bool* kept) {
    const fs::path file = folder_ / (method + ".json");
    const Json settings = Settings(method);
    if (const auto row = Kept(file, settings)) {
      *kept = true;
      return *row;
    }
    *kept = false;
    const FitResult result = ReadFitResult(Run(method));
    const Table1Row row =
        EvaluateMaps(ToUnitWeight(result.maps, result.convention), material_.maps, common_.threads);
    const Json json = {{"settings", settings}, {"errors", JsonOf(row)}};
    WriteFileAtomically(file, json.dump(2) + "\n");
    return row;
  }

 private:
  std::optional<Table1Row> Kept(const fs::path& file, const Json& settings) const {
    if (common_.force || !fs::exists(file)) return std::nullopt;
    const Json json = Json::parse(ReadTextFile(file), nullptr, false);
    if (!json.is_object() || json.value("settings", Json()) != settings) return std::nullopt;
    return RowOf(file, RequireField(file, json, "", "errors"));
  }

  Json Settings(const std::string& method) const {
    Json settings = {{"method", method},
                     {"size", options_.size},
                     {"rule", views_.rule},
                     {"bits", views_.bits},
                     {"encoding", views_.encoding},
                     {"seed", common_.seed},
                     {"fit_arguments", options_.fit_arguments}};
    if (method == "refined") settings["refine_arguments"] = options_.refine_arguments;
    return settings;
  }

  // Runs what `method` needs and returns its manifest. The programs themselves keep what is up to
  // date, so a table that was interrupted goes on where it was.
  fs::path Run(const std::string& method) {
    const std::string fit_method = method == "refined" ? "latent" : method;
    const fs::path capture = folder_ / fit_method;
    WriteViewSet(capture, material_, views_, common_);
    Program("glint-fit", capture, {"--method", fit_method}, options_.fit_arguments);
    if (method != "refined") return capture / "glint" / "fit" / "manifest.json";
    Program("glint-refine", capture, {}, options_.refine_arguments);
    return capture / "glint" / "refine" / "manifest.json";
  }

  void Program(const std::string& name, const fs::path& capture,
               const std::vector<std::string>& first, const std::vector<std::string>& more) {
    std::vector<std::string> argv{SiblingProgram(name).string(), capture.string()};
    argv.insert(argv.end(), first.begin(), first.end());
    argv.insert(argv.end(), {"--threads", std::to_string(common_.threads), "--seed",
                             std::to_string(common_.seed)});
    if (common_.force) argv.push_back("--force");
    argv.insert(argv.end(), more.begin(), more.end());
    RunToLog(argv, folder_ / (capture.filename().string() + ".log"));
  }

  const Table1Options& options_;
  const CommonOptions& common_;
  const MaterialSource& material_;
  ViewSetOptions views_;
  fs::path folder_;
};

void Accumulate(const Table1Row& row, double weight, Table1Row* sum) {
  sum->maps.diffuse += weight * row.maps.diffuse;
  sum->maps.specular += weight * row.maps.specular;
  sum->maps.roughness += weight * row.maps.roughness;
  sum->maps.normal += weight * row.maps.normal;
  sum->render += weight * row.render;
}

void CheckOptions(const Table1Options& options) {
  static const std::vector<std::string> known{"classic", "latent", "refined"};
  for (const std::string& method : options.methods) {
    if (std::find(known.begin(), known.end(), method) == known.end()) {
      throw UserError("methods: found \"" + method + "\"; use classic, latent, refined");
    }
  }
  for (const int count : options.counts) {
    if (count < 1) throw UserError(fmt::format("counts: found {}; use 1 or more", count));
  }
  if (options.size < 8 || options.size > 4096) {
    throw UserError(fmt::format("size: found {}; use 8 to 4096", options.size));
  }
}

}  // namespace

std::vector<Table1Entry> Table1::Means() const {
  std::vector<Table1Entry> means;
  std::vector<int> members;
  const auto place = [&](const Table1Entry& entry) {
    const auto same = [&](const Table1Entry& mean) {
      return mean.count == entry.count && mean.method == entry.method;
    };
    return std::find_if(means.begin(), means.end(), same) - means.begin();
  };
  for (const Table1Entry& entry : entries) {
    const auto at = static_cast<size_t>(place(entry));
    if (at == means.size()) {
      means.push_back({"mean", entry.count, entry.method, {}});
      members.push_back(0);
    }
    ++members[at];
  }
  for (const Table1Entry& entry : entries) {
    const auto at = static_cast<size_t>(place(entry));
    Accumulate(entry.errors, 1.0 / members[at], &means[at].errors);
  }
  std::stable_sort(means.begin(), means.end(),
                   [](const auto& a, const auto& b) { return a.count < b.count; });
  return means;
}

std::string Table1::Text() const {
  std::string text =
      "|  N | method  |  diffuse | specular | roughness |   normal | map average |   render |\n"
      "|---:|---------|---------:|---------:|----------:|---------:|------------:|---------:|\n";
  for (const Table1Entry& mean : Means()) {
    const auto f = Figures(mean.errors);
    text +=
        fmt::format("| {:2} | {:7} | {:.6f} | {:.6f} | {:9.6f} | {:.6f} | {:11.6f} | {:.6f} |\n",
                    mean.count, mean.method, f[0], f[1], f[2], f[3], f[4], f[5]);
  }
  return text;
}

std::string Table1::Csv() const {
  std::string text = "material,views,method";
  for (const char* column : kColumns) text += fmt::format(",{}", column);
  text += "\n";
  const std::vector<Table1Entry> means = Means();
  for (const auto* list : {&entries, &means}) {
    for (const Table1Entry& entry : *list) {
      text += fmt::format("{},{},{}", entry.material, entry.count, entry.method);
      for (const double figure : Figures(entry.errors)) text += fmt::format(",{:.8g}", figure);
      text += "\n";
    }
  }
  return text;
}

Json Table1::ToJson() const {
  const auto list = [](const std::vector<Table1Entry>& rows) {
    Json json = Json::array();
    for (const Table1Entry& entry : rows) {
      json.push_back({{"material", entry.material},
                      {"views", entry.count},
                      {"method", entry.method},
                      {"errors", JsonOf(entry.errors)}});
    }
    return json;
  };
  return {{"means", list(Means())}, {"entries", list(entries)}};
}

Table1 RunTable1(const Table1Options& options, const CommonOptions& common,
                 const std::function<void(const std::string&)>& said) {
  CheckOptions(options);
  Table1 table;
  for (const std::string& name : options.materials) {
    const MaterialSource material = LoadMaterial(name, options.size);
    for (const int count : options.counts) {
      Experiment experiment(options, common, material, count);
      for (const std::string& method : options.methods) {
        bool kept = false;
        const Table1Row row = experiment.Evaluate(method, &kept);
        table.entries.push_back({material.name, count, method, row});
        said(fmt::format("{} n={} {}: map average {:.6f}, render {:.6f}{}", material.name, count,
                         method, row.maps.average(), row.render, kept ? " (kept)" : ""));
      }
    }
  }
  return table;
}

}  // namespace glint
