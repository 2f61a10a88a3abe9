#include "pipeline/driver/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/errors/errors.h"

namespace glint {
namespace {

constexpr int kCannotStart = 127;

std::vector<char*> ArgumentVector(const std::vector<std::string>& arguments) {
  std::vector<char*> vector;
  for (const std::string& argument : arguments) {
    vector.push_back(const_cast<char*>(argument.c_str()));
  }
  vector.push_back(nullptr);
  return vector;
}

EnvironmentError CannotStart(const std::string& program, int error) {
  return EnvironmentError(program + ": cannot be started: " + std::strerror(error) +
                          "; check that Glint is installed completely");
}

// OpenMP's threads spin while they wait, unless told otherwise before the program starts; beside
// any other load on the machine that made fitting six times slower (docs/experiments/run-time.md).
void LetOpenMpWaitPassively() { ::setenv("OMP_WAIT_POLICY", "passive", 0); }

// setenv allocates, which is safe between fork and exec in a program without other threads, and in
// others too where fork keeps the allocator whole, as glibc's does.
void SayOwnNumber(const std::string& variable) {
  if (variable.empty()) return;
  char number[16];
  std::snprintf(number, sizeof(number), "%d", static_cast<int>(::getpid()));
  ::setenv(variable.c_str(), number, 1);
}

// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void BecomeChild(const ChildProcess& child, std::vector<char*>* arguments,
                              int stdout_descriptor, int error_descriptor, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotStart);  // the parent died before the line above
  SayOwnNumber(child.number_variable);
  if (stdout_descriptor >= 0) ::dup2(stdout_descriptor, STDOUT_FILENO);
  if (child.quiet_stderr) {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  }
  for (const int descriptor : child.kept_descriptors) ::fcntl(descriptor, F_SETFD, 0);
  ::execvp(arguments->front(), arguments->data());
  const int error = errno;
  if (::write(error_descriptor, &error, sizeof(error)) < 0) ::_exit(kCannotStart);
  ::_exit(kCannotStart);
}

void ReadLines(int descriptor, const std::function<void(const std::string&)>& on_line) {
  std::string pending;
  char buffer[4096];
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    pending.append(buffer, static_cast<size_t>(count));
    for (size_t end; (end = pending.find('\n')) != std::string::npos;) {
      on_line(pending.substr(0, end));
      pending.erase(0, end + 1);
    }
  }
  if (!pending.empty()) on_line(pending);
}

int Wait(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

// A pipe whose ends close themselves.
struct Pipe {
  int ends[2] = {-1, -1};
  Pipe() {
    if (::pipe2(ends, O_CLOEXEC) != 0) {
      throw EnvironmentError(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
  }
  ~Pipe() {
    Close(0);
    Close(1);
  }
  void Close(int end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
};

}  // namespace

int RunChild(const ChildProcess& child) {
  LetOpenMpWaitPassively();
  for (const auto& [name, value] : child.environment) ::setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> arguments = ArgumentVector(child.arguments);
  std::fflush(nullptr);
  Pipe output, failure;
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) throw CannotStart(child.arguments[0], errno);
  if (pid == 0) {
    BecomeChild(child, &arguments, child.on_line ? output.ends[1] : -1, failure.ends[1], parent);
  }
  output.Close(1);
  failure.Close(1);
  if (child.on_line) ReadLines(output.ends[0], child.on_line);
  int error = 0;
  const bool failed = ::read(failure.ends[0], &error, sizeof(error)) == sizeof(error);
  const int code = Wait(pid);
  if (failed) throw CannotStart(child.arguments[0], error);
  return code;
}

void DieWithParent(const std::string& number_variable) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const char* number = std::getenv(number_variable.c_str());
  if (number != nullptr && ::getppid() != std::atoi(number)) ::raise(SIGKILL);
}

void ReplaceProcess(const std::vector<std::string>& arguments) {
  LetOpenMpWaitPassively();
  std::vector<char*> vector = ArgumentVector(arguments);
  std::fflush(nullptr);
  ::execvp(vector.front(), vector.data());
  throw CannotStart(arguments[0], errno);
}

}  // namespace glint
