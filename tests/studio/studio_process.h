// glint-studio as a process of its own, which tests end or kill.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/support/process.h"

namespace glint::test {

struct StudioProcess {
  // Serves `folder`; what it prints goes to files in `scratch`.
  StudioProcess(const std::filesystem::path& folder, const std::filesystem::path& scratch)
      : out(scratch / "out"), err(scratch / "err") {
    std::filesystem::remove(out);
    pid = Start({std::string(GLINT_BIN_DIR) + "/glint-studio", folder.string(), "--no-browser",
                 "--port", "0"},
                out, err);
    for (int i = 0; i < 500 && address.empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const std::string text = ReadAll(out);
      const size_t at = text.find("http://"), end = text.find('\n', at);
      if (at != std::string::npos && end != std::string::npos) address = text.substr(at, end - at);
    }
  }
  ~StudioProcess() { End(SIGKILL); }
  StudioProcess(const StudioProcess&) = delete;
  StudioProcess& operator=(const StudioProcess&) = delete;

  // Its exit code, or 128 + the signal.
  int End(int signal) {
    if (pid <= 0) return -1;
    ::kill(pid, signal);
    const int code = WaitFor(pid);
    pid = 0;
    return code;
  }

  std::filesystem::path out, err;
  pid_t pid = 0;
  std::string address;  // with the secret; empty: it did not start
};

}  // namespace glint::test
