// A table row of docs/reliability.md: something done to Glint many times, and how often it went
// wrong.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

namespace glint::test {

// GLINT_TRIALS scales all numbers of trials; 1 is what docs/reliability.md reports.
inline int Scaled(int trials) {
  const char* scale = std::getenv("GLINT_TRIALS");
  return std::max(1, static_cast<int>(trials * (scale == nullptr ? 1.0 : std::atof(scale))));
}

// `trial(i)` returns what went wrong; "": nothing.
inline void RunTrials(const std::string& what, int trials,
                      const std::function<std::string(int)>& trial) {
  int failures = 0;
  trials = Scaled(trials);
  for (int i = 0; i < trials; ++i) {
    const std::string problem = trial(i);
    if (problem.empty()) continue;
    ++failures;
    ADD_FAILURE() << what << ", trial " << i << ": " << problem;
  }
  std::printf("| %s | %d | %d |\n", what.c_str(), trials, failures);
  std::fflush(stdout);
}

}  // namespace glint::test
