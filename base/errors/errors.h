// The three ways a program of Glint ends badly. Bugs are none of them: those are assertions.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace glint {

enum ExitCode : int {
  kExitDone = 0,
  kExitComputation = 1,  // the computation failed: not converged, too few corners
  kExitUser = 2,         // wrong usage or input
  kExitEnvironment = 3   // disk full, missing program
};

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

// Wrong usage or input. One sentence: "FILE: FIELD: found FOUND; REMEDY".
class UserError : public Error {
 public:
  explicit UserError(const std::string& message) : Error(kExitUser, message) {}
  UserError(const std::filesystem::path& file, const std::string& field, const std::string& found,
            const std::string& remedy)
      : UserError(file.string() + ": " + (field.empty() ? "" : field + ": ") + "found " + found +
                  "; " + remedy) {}
};

class ComputationError : public Error {
 public:
  explicit ComputationError(const std::string& message) : Error(kExitComputation, message) {}
};

class EnvironmentError : public Error {
 public:
  explicit EnvironmentError(const std::string& message) : Error(kExitEnvironment, message) {}
};

}  // namespace glint
