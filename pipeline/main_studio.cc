// glint-studio: captures in a browser, from photographs to the material.
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/errors/errors.h"
#include "base/programs/program.h"
#include "base/programs/subprocess.h"
#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/studio.h"

namespace {

void OpenBrowser(const std::string& address) {
  std::thread([address] {
    try {
      glint::OpenOnDesktop(address);
    } catch (const glint::Error&) {  // the address stands on the terminal
    }
  }).detach();
}

// Signals that end Studio are waited for; its threads, begun later, do not get them.
sigset_t BlockEndingSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

glint::ProgramResult Serve(const glint::StudioOptions& options, bool browser) {
  const sigset_t signals = BlockEndingSignals();
  // Before there are threads: children are to get it, see driver/child_process.cc.
  ::setenv("OMP_WAIT_POLICY", "passive", 0);
  try {
    const glint::Studio studio(options);
    std::printf("Glint Studio: %s\n", studio.address().c_str());
    if (!studio.lan_address().empty()) {
      std::printf("in this network: %s\n", studio.lan_address().c_str());
    }
    std::printf("Ctrl-C ends it.\n");
    std::fflush(stdout);
    if (browser) OpenBrowser(studio.address());
    int signal = 0;
    sigwait(&signals, &signal);
  } catch (const glint::HttpError& error) {
    throw glint::EnvironmentError(error.message + "; " + error.remedy);
  }
  return {"", glint::Json::object()};
}

}  // namespace

int main(int argc, char** argv) {
  glint::StudioOptions o;
  o.version = GLINT_VERSION;
  o.prepare_options = true;
  bool no_browser = false;
  glint::OptionSet options;
  options.AddPositional("FOLDER", &o.folder, "folder of captures", false);
  options.AddRange("port", &o.port, 0, 65535, "port on 127.0.0.1; 0: any free one");
  options.Add("lan", &o.lan,
              "also accept other machines on the network, at a second address with its own secret");
  options.Add("no-browser", &no_browser, "only print the address");
  return glint::RunProgram(
      argc, argv,
      {"glint-studio",
       "Opens a folder of captures in the browser: take photographs with a phone, with advice on "
       "what to shoot next, run the stages, and view the material.",
       GLINT_VERSION, "Examples:\n  glint studio captures\n  glint studio --no-browser --port 0",
       false},
      &options, [&](const glint::CommonOptions& common) {
        o.check_threads = common.threads;
        return Serve(o, !no_browser);
      });
}
