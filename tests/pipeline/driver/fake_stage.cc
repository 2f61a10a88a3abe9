// A stage that computes next to nothing and starts in a blink, for tests of what runs the stages.
// Its name, glint-<stage>, says which one it is; it reads what the real stage reads, keeps a
// manifest with a key as real stages do, and writes one text.
//   option "gain": enters the result · "fail" N: ends with exit code N after writing an output ·
//   "die": ends by SIGKILL · "sleep" S: takes S seconds · "part" K/N: writes a file for it alone ·
//   "join" N: ends with exit code 2 where one of these is missing
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fstream>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/hash.h"
#include "base/formats/manifest.h"
#include "base/programs/options.h"
#include "base/stages/stages.h"

namespace fs = std::filesystem;

namespace {

struct FakeOptions {
  fs::path folder;
  double gain = 1, sleep_s = 0;
  int fail = 0, finest_size = 256;
  bool die = false;
  std::string method = "latent", from = "refine";
  std::vector<std::string> exclude, views;
  // Those that RunProgram gives to every program.
  bool check = false, force = false, json = false;
  std::string log_level;
  int threads = 0;
  double memory_gb = 0;
  std::string part;
  int join = 0;
};

fs::path PartFile(const FakeOptions& o, const std::string& stage, const std::string& part) {
  return o.folder / "glint" / (stage + "-" + part + ".txt");
}

void JoinParts(const FakeOptions& o, const std::string& stage) {
  for (int k = 1; k <= o.join; ++k) {
    const std::string part = std::to_string(k) + "of" + std::to_string(o.join);
    if (!fs::remove(PartFile(o, stage, part))) {
      throw glint::UserError("part " + part + " is missing");
    }
  }
}

std::vector<fs::path> Inputs(const FakeOptions& o, const std::string& stage) {
  const glint::StageKind& kind = *glint::FindStage(stage);
  std::vector<fs::path> files;
  if (kind.reads.photographs) {
    for (const auto& entry : fs::directory_iterator(o.folder / "photos")) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
  }
  const auto add_stage = [&](std::string_view name) {
    files.push_back(o.folder / glint::ManifestPath(name));
  };
  const auto add_last = [&](glint::Gives what) { add_stage(glint::LastGiving(what, stage)->name); };
  if (kind.reads.calibration) add_last(glint::Gives::kCalibration);
  if (kind.reads.views) add_last(glint::Gives::kViews);
  if (kind.is_told.maps_from) {
    add_stage(o.from);
  } else if (kind.reads.maps != glint::ReadsMaps::kNone) {
    add_last(glint::Gives::kMaps);
  }
  if (stage == "fit" && fs::exists(o.folder / "weights")) files.push_back(o.folder / "weights");
  return files;
}

std::string WhyStale(const fs::path& file, const glint::Manifest& wanted) {
  if (!fs::exists(file)) return "there is no result yet";
  try {
    const glint::Manifest manifest = glint::ReadManifest(file, wanted.stage);
    glint::VerifyOutputs(file, manifest);
    for (const auto& [name, value] : wanted.options.items()) {
      const auto& before = manifest.options.at(name);
      if (before != value)
        return "option " + name + " was " + before.dump() + " and is " + value.dump();
    }
    if (glint::ToJson(manifest)["inputs"] != glint::ToJson(wanted)["inputs"]) return "inputs";
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

int RunStage(const std::string& name, const FakeOptions& o, const glint::OptionSet& options) {
  const fs::path folder = fs::absolute(o.folder / "glint" / name).lexically_normal();
  glint::Manifest manifest;
  manifest.stage = name;
  manifest.options = options.ManifestEcho();
  for (const fs::path& input : Inputs(o, name)) {
    const fs::path path = fs::absolute(input).lexically_normal().lexically_relative(folder);
    manifest.inputs.push_back({path.generic_string(), glint::HashFile(input)});
  }
  const std::string why = WhyStale(folder / "manifest.json", manifest);
  if (o.check) {
    const glint::Json answer = {{"stage", name}, {"up_to_date", why.empty()}, {"why_stale", why}};
    std::printf("%s\n", answer.dump().c_str());
    return 0;
  }
  if (why.empty() && !o.force) return 0;
  if (!o.part.empty()) {
    std::string part = o.part;
    part.replace(part.find('/'), 1, "of");
    std::ofstream(PartFile(o, name, part)) << part;
    return 0;
  }
  JoinParts(o, name);
  const fs::path fresh = folder.parent_path() / ("." + name + ".new");
  fs::remove_all(fresh);
  fs::create_directories(fresh);
  const std::string text = manifest.options.dump();
  std::ofstream(fresh / "result.txt") << text;
  if (o.sleep_s > 0) ::usleep(static_cast<useconds_t>(o.sleep_s * 1e6));
  if (o.die) ::raise(SIGKILL);
  if (o.fail != 0) {
    throw glint::Error(static_cast<glint::ExitCode>(o.fail),
                       (o.folder / "capture.toml").string() + ": made to fail");
  }
  manifest.outputs.push_back({"result.txt", glint::HashBytes(text), 0, 0, {}});
  glint::WriteFileAtomically(fresh / "manifest.json", glint::ToJson(manifest).dump(2));
  const glint::Json facts = {{"command_line", options.CommandLineEcho()}};
  glint::WriteFileAtomically(fresh / "run.json", facts.dump());
  fs::remove_all(folder);
  fs::rename(fresh, folder);
  std::printf("%s: done\n", name.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string program = fs::path(argv[0]).filename();
  FakeOptions o;
  glint::OptionSet options;
  options.AddPositional("CAPTURE", &o.folder, "folder", true);
  options.Add("gain", &o.gain, "enters the result");
  options.Add("method", &o.method, "enters the result");
  options.Add("from", &o.from, "which maps");
  options.Add("finest-size", &o.finest_size, "enters the result");
  options.Add("exclude", &o.exclude, "enters the result");
  options.Add("views", &o.views, "enters the result");
  options.Add("fail", &o.fail, "exit code", glint::Invalidates::kNo);
  options.Add("die", &o.die, "by SIGKILL", glint::Invalidates::kNo);
  options.Add("sleep", &o.sleep_s, "seconds", glint::Invalidates::kNo);
  options.Add("part", &o.part, "K/N", glint::Invalidates::kNo);
  options.Add("join", &o.join, "parts", glint::Invalidates::kNo);
  CLI::App app;
  options.Register(&app);
  app.add_flag("--status", o.check);
  app.add_flag("--force", o.force);
  app.add_flag("--json", o.json);
  app.add_option("--log-level", o.log_level);
  app.add_option("--threads", o.threads);
  app.add_option("--memory", o.memory_gb);
  try {
    app.parse(argc, argv);
    const std::string stage = program.substr(std::string("glint-").size());
    options.LoadToml(o.folder / "capture.toml", stage);
    return RunStage(stage, o, options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const glint::Error& error) {
    std::fprintf(stderr, "%s: error: %s\n", program.c_str(), error.what());
    return error.code();
  }
}
