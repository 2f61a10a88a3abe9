#include "base/programs/program.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <system_error>
#include <thread>

#include "base/errors/errors.h"
#include "base/files/memory_limit.h"
#include "base/images/exr_rows.h"
#include "base/programs/help_formatter.h"
#include "base/programs/stage.h"

namespace glint {
namespace {

constexpr int kMaxThreads = 1024;
constexpr double kMostMemory_gb = 1e6;

void SetUpLogging(const std::string& program, const std::string& level) {
  auto logger = spdlog::stderr_logger_mt(program);
  logger->set_pattern(program + ": %l: %v");
  logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(logger);
}

// An empty message: it has been said already (by a child process).
int Report(const ProgramInfo& info, int code, const std::string& message) {
  if (message.empty()) return code;
  std::fprintf(stderr, "%s: error: %s\n", info.name.c_str(), message.c_str());
  return code;
}

// "fit        latent, 380 iterations, log-L1 0.129 -> 0.0729            20.3 s"; further lines of
// the summary follow.
std::string OneLine(const std::string& program, const std::string& summary, double seconds) {
  constexpr size_t kPrefix = sizeof("glint-") - 1;
  const size_t end = std::min(summary.find('\n'), summary.size());
  return fmt::format("{:<9} {:<58} {:>6.1f} s", program.substr(kPrefix), summary.substr(0, end),
                     seconds) +
         summary.substr(end);
}

bool OneLineWanted() { return std::getenv(kOneLineVariable) != nullptr; }

int PrintResult(const ProgramInfo& info, const ProgramResult& result, bool json, double seconds) {
  std::string text =
      json ? result.json.dump(2, ' ', false, Json::error_handler_t::replace) : result.text;
  if (!json && !result.summary.empty() && OneLineWanted()) {
    text = OneLine(info.name, result.summary, seconds);
  }
  if (!text.empty() && text.back() != '\n') text += '\n';
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
    // Whoever read has gone (glint run | head): what was asked for is done all the same.
    if (errno == EPIPE) return kExitDone;
    return Report(info, kExitEnvironment, "cannot write the result to stdout; is the disk full?");
  }
  return kExitDone;
}

Json DescriptionOf(const ProgramInfo& info, const OptionSet& options) {
  return {{"program", info.name},
          {"description", info.description},
          {"footer", info.footer},
          {"version", info.version},
          {"options", options.Describe()}};
}

int RunBody(const ProgramInfo& info, const CommonOptions& common,
            const std::function<ProgramResult(const CommonOptions&)>& body) {
  constexpr double kGiga = 1e9;
  SetMemoryLimit(static_cast<std::uint64_t>(kGiga * common.memory_gb));
  SetExrThreads(common.threads);
  const auto began = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  };
  try {
    const ProgramResult result = body(common);
    return PrintResult(info, result, common.json, seconds());
  } catch (const StageCheck& check) {
    return PrintResult(info, {ToText(check), ToJson(check), ""}, common.json, seconds());
  } catch (const Error& error) {
    return Report(info, error.code(), error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    const auto path = error.path1().string();
    return Report(info, kExitEnvironment,
                  (path.empty() ? "" : path + ": ") + error.code().message() +
                      "; check the folder, its permissions and the free space");
  } catch (const std::bad_alloc&) {
    return Report(info, kExitEnvironment,
                  "not enough memory; lower the resolution or the number of photographs");
  } catch (const std::exception& error) {
    return Report(info, kExitComputation, error.what());
  }
}

}  // namespace

OptionSet CommonOptionSet(CommonOptions* common, bool keeps_results) {
  OptionSet set;
  set.AddRange("threads", &common->threads, 0, kMaxThreads,
               "threads to use; 0: one per core; does not affect the result");
  set.AddRange(
      "memory", &common->memory_gb, 0, kMostMemory_gb,
      "memory limit in GB; a stage that would exceed it fails with an error; 0: 80 % of the "
      "memory of the machine (or of the process's cgroup); does not affect the result");
  set.Add("seed", &common->seed, "random seed");
  set.AddChoice("log-level", &common->log_level, {"debug", "info", "warning", "error", "off"},
                "verbosity on stderr");
  set.Add("json", &common->json, "write the result to stdout as JSON");
  if (!keeps_results) return set;
  set.Add("force", &common->force, "compute even if the result is up to date");
  set.Add("status", &common->check, "only report whether the result is up to date");
  return set;
}

int RunProgram(int argc, char** argv, const ProgramInfo& info, OptionSet* options,
               const std::function<ProgramResult(const CommonOptions&)>& body) {
  // A write past a file-size limit is an error to report, not a reason to die.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  if (argc == 2 && std::strcmp(argv[1], kDescribeFlag) == 0) {
    return PrintResult(info, {"", DescriptionOf(info, *options)}, true, 0);
  }
  CommonOptions common;
  CLI::App app(info.description, info.name);
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_version_flag("--version", info.name + " " + info.version);
  if (!info.footer.empty()) app.footer(info.footer);
  options->Register(&app);
  OptionSet common_options = CommonOptionSet(&common, info.keeps_results);
  common_options.Register(&app, "Common");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    app.exit(help);
    return kExitDone;
  } catch (const CLI::CallForVersion& version) {
    app.exit(version);
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    return Report(info, kExitUser, std::string(error.what()) + "; see " + info.name + " --help");
  }
  if (common.threads == 0) {
    common.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }
  SetUpLogging(info.name, common.log_level);
  return RunBody(info, common, body);
}

}  // namespace glint
