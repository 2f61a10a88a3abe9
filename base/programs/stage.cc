#include "base/programs/stage.h"

#include <fcntl.h>
#include <linux/fs.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "base/cpu/instruction_set.h"
#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/images/image.h"
#include "base/photos/decode_count.h"
#include "base/programs/run_progress.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct ResourceUse {
  double processor_s = 0;              // of all threads, children that have ended included
  std::int64_t peak_memory_bytes = 0;  // of this process or of its largest child
};

ResourceUse UsedResources() {
  ResourceUse use;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    use.processor_s += seconds(usage.ru_utime) + seconds(usage.ru_stime);
    use.peak_memory_bytes =
        std::max(use.peak_memory_bytes, std::int64_t{1024} * usage.ru_maxrss);  // Linux: kilobytes
  }
  return use;
}

// Since the kernel began this process; 0: it does not tell.
double SecondsSinceStart() {
  constexpr int kStartTime = 20;  // the 22nd field; the second may hold spaces, and ends with ')'
  std::ifstream stream("/proc/self/stat");
  std::string text, field;
  if (!std::getline(stream, text) || text.rfind(')') == std::string::npos) return 0;
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  for (int i = 0; i < kStartTime; ++i) fields >> field;
  timespec now{};
  if (!fields || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0;
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
         std::stod(field) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

struct BytesMoved {
  std::int64_t read = 0, written = 0;
};

// By this process and its children that have ended, from the page cache or from a disk; files that
// are mapped into memory (libraries) are not counted. Zeros: the kernel does not count.
BytesMoved MovedBytes() {
  BytesMoved bytes;
  std::ifstream stream("/proc/self/io");
  std::string name;
  for (std::int64_t value = 0; stream >> name >> value;) {
    if (name == "rchar:") bytes.read = value;
    if (name == "wchar:") bytes.written = value;
  }
  return bytes;
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw EnvironmentError(folder.string() + ": cannot create the folder: " + error.message() +
                           "; check its permissions and the free space");
  }
}

void SyncFile(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  const int result = ::fsync(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (result != 0 && error != EINVAL) {
    throw EnvironmentError(file.string() + ": cannot be written to the disk: " +
                           std::strerror(error) + "; free some space and run again");
  }
}

// Puts `fresh` at `folder`'s place. With an old result there the two are exchanged in one step
// where the file system can (Linux: ext4, xfs, btrfs, tmpfs); elsewhere the old one is moved aside
// first.
void Exchange(const fs::path& fresh, const fs::path& folder) {
  if (!fs::exists(folder)) {
    fs::rename(fresh, folder);
    return;
  }
  if (::syscall(SYS_renameat2, AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(),
                RENAME_EXCHANGE) == 0) {
    return;
  }
  const fs::path aside = fresh.string() + ".old";
  fs::remove_all(aside);
  fs::rename(folder, aside);
  fs::rename(fresh, folder);
  fs::remove_all(aside);
}

// Of an image as stages write them.
std::optional<ImageHeader> HeaderOf(const fs::path& file) {
  if (file.extension() == ".exr") return ReadExrHeader(file);
  if (file.extension() == ".png") return ReadPngHeader(file);
  return std::nullopt;
}

// Whether a file is no part of the capture whose stage folder CAPTURE/glint/STAGE is: its path from
// there depends on where the capture lies.
bool IsOutside(const fs::path& file, const fs::path& stage_folder) {
  const fs::path capture = stage_folder.parent_path().parent_path();
  const fs::path relative = file.lexically_relative(capture);
  return relative.empty() || *relative.begin() == "..";
}

ManifestOutput Describe(const fs::path& folder, const std::string& name) {
  ManifestOutput output;
  output.path = name;
  output.hash = HashFile(folder / name);
  if (const auto header = HeaderOf(folder / name)) {
    output.width = header->width;
    output.height = header->height;
    output.channels = header->channels;
  }
  return output;
}

// The first option whose value differs, in words; empty: none.
std::string OptionChange(const Json& before, const Json& now) {
  for (const auto& [name, value] : now.items()) {
    const auto found = before.find(name);
    if (found == before.end()) return "option " + name + " is new";
    if (*found != value) {
      return "option " + name + " was " + found->dump() + " and is now " + value.dump();
    }
  }
  for (const auto& [name, value] : before.items()) {
    if (!now.contains(name)) return "option " + name + " is gone";
  }
  return "";
}

// The first input that differs, in words; empty: none.
std::string InputChange(const std::vector<ManifestInput>& before,
                        const std::vector<ManifestInput>& now) {
  std::map<std::string, std::string> hashes;
  for (const ManifestInput& input : before) hashes[input.path] = input.hash;
  for (const ManifestInput& input : now) {
    const auto found = hashes.find(input.path);
    if (found == hashes.end()) return "input " + input.path + " is new";
    if (found->second != input.hash) return "input " + input.path + " has changed";
  }
  if (now.size() != before.size()) return "some inputs are no longer read";
  for (size_t i = 0; i < now.size(); ++i) {
    if (now[i].path != before[i].path) return "the order of the inputs has changed";
  }
  return "";
}

}  // namespace

Stage::Stage(fs::path folder, StageInfo info, const OptionSet& options, const CommonOptions& common,
             std::vector<fs::path> inputs, bool force)
    : folder_(fs::absolute(folder).lexically_normal()),
      info_(std::move(info)),
      options_(options.ManifestEcho()),
      run_options_(options.RunEcho()),
      command_line_(options.CommandLineEcho()),
      threads_(common.threads),
      started_s_(SecondsSince1970()) {
  options_["seed"] = common.seed;
  for (const fs::path& input : inputs) {
    const fs::path file = fs::absolute(input).lexically_normal();
    const bool outside = IsOutside(file, folder_);
    inputs_.push_back({outside ? kOutsidePrefix + file.filename().string()
                               : file.lexically_relative(folder_).generic_string(),
                       HashFile(input)});
    if (outside) outside_inputs_.push_back(file.generic_string());
  }
  if (common.check) throw StageCheck{info_.name, WhyStale()};
  MakeFolder(folder_.parent_path());
  lock_ = std::make_unique<FileLock>(folder_.parent_path() / (".lock-" + info_.name),
                                     "stage " + info_.name + " of this capture");
  fs::remove_all(staging());
  // Where no exchange is possible, a kill may have left the old result aside with none in place.
  const fs::path aside = staging().string() + ".old";
  if (fs::exists(aside) && !fs::exists(folder_)) fs::rename(aside, folder_);
  fs::remove_all(aside);
  if (force || common.force || !fs::exists(manifest_file())) return;
  const std::string why = WhyStale();
  up_to_date_ = why.empty();
  if (!up_to_date_) spdlog::info("{}; recomputing the stage", why);
}

std::string Stage::WhyStale() const {
  if (!fs::exists(manifest_file())) return "there is no result yet";
  try {
    const Manifest manifest = ReadManifest(manifest_file(), info_.name);
    if (manifest.stage_version != info_.version) {
      return "the result is from stage version " + std::to_string(manifest.stage_version) +
             ", the program has version " + std::to_string(info_.version);
    }
    if (const std::string why = OptionChange(manifest.options, options_); !why.empty()) return why;
    if (const std::string why = InputChange(manifest.inputs, inputs_); !why.empty()) return why;
    VerifyOutputs(manifest_file(), manifest);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

std::string ToText(const StageCheck& check) {
  return check.stage + ": " +
         (check.why_stale.empty() ? "up to date" : "stale: " + check.why_stale);
}

Json ToJson(const StageCheck& check) {
  return {{"stage", check.stage},
          {"up_to_date", check.why_stale.empty()},
          {"why_stale", check.why_stale}};
}

fs::path Stage::staging() const {
  return folder_.parent_path() / ("." + folder_.filename().string() + ".new");
}

fs::path Stage::Output(const std::string& name) {
  outputs_.push_back(name);
  const fs::path file = staging() / name;
  MakeFolder(file.parent_path());
  return file;
}

void Stage::WriteRunFacts() const {
  const double finished_s = SecondsSince1970();
  const std::time_t started = static_cast<std::time_t>(started_s_);
  char text[32];
  std::tm utc{};
  gmtime_r(&started, &utc);
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &utc);
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  const ResourceUse use = UsedResources();
  const BytesMoved bytes = MovedBytes();
  const DecodeCounts decoded = PhotosDecoded();
  const Json facts = {{"started", text},
                      {"seconds", finished_s - started_s_},
                      {"process_seconds", SecondsSinceStart()},
                      {"processor_seconds", use.processor_s},
                      {"peak_memory_bytes", use.peak_memory_bytes},
                      {"bytes_read", bytes.read},
                      {"bytes_written", bytes.written},
                      {"photographs_decoded", decoded.whole},
                      {"photographs_decoded_reduced", decoded.reduced},
                      {"host", host},
                      {"instruction_sets", InstructionSetNames()},
                      {"threads", threads_},
                      {"outside", outside_inputs_},
                      {"options", run_options_},
                      {"command_line", command_line_}};
  WriteFileAtomically(staging() / "run.json", facts.dump(2) + "\n");
}

void Stage::Commit(const Json& data, const Json& metrics) {
  MakeFolder(staging());
  Manifest manifest;
  manifest.stage = info_.name;
  manifest.stage_version = info_.version;
  manifest.inputs = inputs_;
  manifest.options = options_;
  manifest.data = data;
  manifest.metrics = metrics;
  for (const std::string& name : outputs_) {
    SyncFile(staging() / name);
    manifest.outputs.push_back(Describe(staging(), name));
  }
  WriteRunFacts();
  WriteFileAtomically(staging() / "manifest.json",
                      ToJson(manifest).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  SyncFile(staging());
  Exchange(staging(), folder_);
  SyncFile(folder_.parent_path());
  fs::remove_all(staging());
  up_to_date_ = true;
}

std::string Stage::UpToDateText() const {
  return info_.name + ": up to date (" + manifest_file().string() + ")";
}

ProgramResult Stage::UpToDateResult(const Json& more) const {
  Json json = {{"stage", info_.name}, {"up_to_date", true}, {"manifest", manifest_file().string()}};
  json.update(more);
  return {UpToDateText(), json, "up to date"};
}

}  // namespace glint
