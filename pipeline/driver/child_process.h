// Other programs run as children that never outlive their parent.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace glint {

struct ChildProcess {
  std::vector<std::string> arguments;              // arguments[0]: the program, found in PATH
  std::map<std::string, std::string> environment;  // added to this process's own
  std::vector<int> kept_descriptors;               // stay open in the child and its children
  // Environment variable that gets the child's own process number, for DieWithParent in its
  // children; "": none.
  std::string number_variable;
  // Called for each line of the child's stdout (without the newline); empty: stdout is shared.
  std::function<void(const std::string&)> on_line;
  bool quiet_stderr = false;  // what it says there goes nowhere
};

// How a child ended, as a shell says it: its exit code, or 128 + the signal that killed it.
// The child is killed when this process dies, however that happens (Linux: PR_SET_PDEATHSIG).
// Throws EnvironmentError when it cannot be started.
int RunChild(const ChildProcess& child);

// Has this process killed when its parent dies. The parent whose number stands in the environment
// variable `number_variable` may have died before this call, which the kernel does not tell: then
// the process ends here, as if killed.
void DieWithParent(const std::string& number_variable);

// Replaces this process by another program. Returns only by throwing EnvironmentError.
[[noreturn]] void ReplaceProcess(const std::vector<std::string>& arguments);

}  // namespace glint
