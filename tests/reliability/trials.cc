// What may happen to a run, many times over: ./dev reliability. Every trial ends with a run that
// goes on without help and gives the bytes of one that nothing happened to.
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <random>
#include <set>
#include <thread>

#include "base/files/json.h"
#include "tests/e2e/capture_fixture.h"
#include "tests/fuzz/targets.h"
#include "tests/reliability/trials.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr char kDriver[] = "glint";
const std::vector<std::string> kStages = {"calib", "rectify", "fit", "refine", "export", "report"};

class Trials : public CaptureTest {
 protected:
  std::mt19937 random_{1};
  double Moment(double seconds) {
    return std::uniform_real_distribution<double>(0, seconds)(random_);
  }
  pid_t Begin(const std::vector<std::string>& words, const std::function<void()>& before = {}) {
    return Start(words, folder() / "out", folder() / "err", before);
  }
  std::string Said() const { return ReadAll(folder() / "err"); }
  std::vector<std::string> Run(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {Program(kDriver), "run", capture().string()});
    return more;
  }
  static void Sleep(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }
  // What a further run makes of things as they lie.
  std::string Recovered() const {
    const Outcome outcome = RunCapture();
    if (outcome.code != 0) return "the next run failed: " + outcome.err;
    return Differences(Results(finished()), Results(capture()));
  }
  void Reset() const {
    fs::remove_all(capture());
    CopyCapture(finished(), capture());
  }
};

TEST_F(Trials, KillRun) {
  RunTrials(
      "`kill -9` of `glint run` (alternately the process alone and its process group), at any "
      "moment",
      50, [&](int i) {
        fs::remove_all(capture() / "glint");
        const pid_t pid = Begin(Run());
        Sleep(Moment(run_seconds()));
        ::kill(i % 2 == 0 ? pid : -pid, SIGKILL);
        const int code = WaitFor(pid);
        if (code != 0 && code != 128 + SIGKILL) return Said();
        return Recovered();
      });
}

TEST_F(Trials, KillStage) {
  for (const std::string& stage : kStages) {
    const auto start = Clock::now();
    EXPECT_EQ(RunProgram({Program("glint-" + stage), capture(), "--force"}).code, 0);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    RunTrials("`kill -9` of `glint-" + stage + " --force`, at any moment", 50, [&](int) {
      const pid_t pid = Begin({Program("glint-" + stage), capture(), "--force"});
      Sleep(Moment(seconds));
      ::kill(pid, SIGKILL);
      const int code = WaitFor(pid);
      if (code != 0 && code != 128 + SIGKILL) return Said();
      return Recovered();
    });
  }
}

TEST_F(Trials, Interrupt) {
  for (const auto& [name, signal] : {std::pair{"SIGINT", SIGINT}, std::pair{"SIGTERM", SIGTERM}}) {
    RunTrials(std::string(name) +
                  " to `glint run`, at any moment: nothing keeps running, exit code 128 + signal",
              20, [&, signal = signal](int i) {
                fs::remove_all(capture() / "glint");
                const pid_t pid = Begin(Run());
                Sleep(Moment(run_seconds()));
                // As a terminal does it, to the group; or to the program alone.
                ::kill(i % 2 == 0 ? -pid : pid, signal);
                const int code = WaitFor(pid);
                if (code != 0 && code != 128 + signal)
                  return "exit code " + std::to_string(code) + ": " + Said();
                return Recovered();
              });
  }
}

TEST_F(Trials, TwoRuns) {
  RunTrials("two concurrent `glint run` of one capture: one runs, the other reports it", 10,
            [&](int) {
              fs::remove_all(capture() / "glint");
              const pid_t first = Begin(Run());
              Sleep(Moment(0.2 * run_seconds()));
              const pid_t second = Start(Run(), folder() / "out2", folder() / "err2");
              const std::set<int> codes = {WaitFor(first), WaitFor(second)};
              if (codes != std::set<int>{0, 2} && codes != std::set<int>{0})
                return Said() + ReadAll(folder() / "err2");
              return Recovered();
            });
}

// A file system of so many bytes over glint/, in a mount namespace of the run's own.
bool MountSmall(const fs::path& folder, int kilobytes) {
  const std::string size = "size=" + std::to_string(kilobytes) + "k";
  return ::unshare(CLONE_NEWNS) == 0 &&
         ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("tmpfs", folder.c_str(), "tmpfs", 0, size.c_str()) == 0;
}

TEST_F(Trials, FullDisk) {
  RunTrials(
      "a disk (tmpfs of 8 to 2,000 kB) that fills up during a run: exit code 3, the file named", 20,
      [&](int i) {
        const fs::path work = capture() / "glint";
        const Outcome outcome = RunProgram(Run(), [&] {
          if (!MountSmall(work, 8 + 105 * i)) ::_exit(77);
        });
        if (outcome.code == 77) return std::string("no right to mount a file system here");
        if (outcome.code != 0 &&
            (outcome.code != 3 || outcome.err.find("space") == std::string::npos)) {
          return "exit code " + std::to_string(outcome.code) + ": " + outcome.err;
        }
        return Recovered();
      });
}

TEST_F(Trials, BadDisk) {
  RunTrials("a disk whose writes fail (EIO) from a random write on: exit code 3, the file named",
            40, [&](int i) {
              fs::remove_all(capture() / "glint");
              const int at = 1 + static_cast<int>(random_() % (i < 20 ? 20 : 200));
              const Outcome outcome = RunProgram(Run(), [&] {
                ::setenv("LD_PRELOAD", GLINT_FAULT_INJECTOR, 1);
                ::setenv("GLINT_FAULT_UNDER", (capture() / "glint").c_str(), 1);
                ::setenv("GLINT_FAULT_AT", std::to_string(at).c_str(), 1);
              });
              if (outcome.code != 0 &&
                  (outcome.code != 3 ||
                   outcome.err.find((capture() / "glint").string()) == std::string::npos)) {
                return "write " + std::to_string(at) + ", exit code " +
                       std::to_string(outcome.code) + ": " + outcome.err;
              }
              if (outcome.code == 0) return Differences(Results(finished()), Results(capture()));
              return Recovered();
            });
}

TEST_F(Trials, OrdinaryUserWithoutPermission) {
  RunTrials(
      "an ordinary user in another user's folder: exit code 3, the remedy named", 3, [&](int i) {
        fs::permissions(folder(), fs::perms(0755));
        if (i % 2 == 0) fs::remove_all(capture() / "glint");
        WriteAll(capture() / "capture.toml", ReadAll(capture() / "capture.toml") + "# changed\n");
        const Outcome outcome = RunProgram(Run({"--force"}), [] {
          if (::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(77);
        });
        if (outcome.code == 77) return std::string("cannot become another user here");
        if (outcome.code != 3 || outcome.err.find("writable") == std::string::npos) {
          return "exit code " + std::to_string(outcome.code) + ": " + outcome.err;
        }
        return Recovered();
      });
}

TEST_F(Trials, Stdout) {
  RunTrials(
      "stdout closed, full (/dev/full) or a pipe without a reader: results are written, a lost "
      "answer is reported",
      9, [&](int i) {
        fs::remove_all(capture() / "glint");
        const bool json = i >= 3;
        const Outcome outcome = RunProgram(
            Run(json ? std::vector<std::string>{"--json"} : std::vector<std::string>{}), [&] {
              if (i % 3 == 0) ::close(1);
              if (i % 3 == 1) ::dup2(::open("/dev/full", O_WRONLY), 1);
              if (i % 3 == 2) {
                int ends[2];
                if (::pipe(ends) != 0) ::_exit(77);
                ::dup2(ends[1], 1);
                ::close(ends[0]);
                ::close(ends[1]);
              }
            });
        if (outcome.code != 0 && outcome.code != 3 && outcome.code != 128 + SIGPIPE) {
          return "exit code " + std::to_string(outcome.code) + ": " + outcome.err;
        }
        if (outcome.code == 3 && outcome.err.find("stdout") == std::string::npos)
          return outcome.err;
        // Who closes a pipe does not want the rest; who fills a disk does.
        if (json && outcome.code == 0 && i % 3 != 2)
          return std::string("a lost answer was not reported");
        return Recovered();
      });
}

TEST_F(Trials, FlippedByte) {
  std::vector<std::string> files;
  for (const auto& [path, content] : Results(finished())) {
    if (!content.empty()) files.push_back(path);
  }
  RunTrials("one byte changed in one of " + std::to_string(files.size()) +
                " kinds of results, its times kept: the next run recomputes it",
            100, [&](int i) {
              const fs::path file =
                  capture() / "glint" / files[static_cast<size_t>(i) % files.size()];
              const auto time = fs::last_write_time(file);
              std::string bytes = ReadAll(file);
              bytes[random_() % bytes.size()] ^= static_cast<char>(1 << random_() % 8);
              WriteAll(file, bytes);
              fs::last_write_time(file, time);
              const std::string problem = Recovered();
              if (!problem.empty()) Reset();
              return problem.empty() ? "" : file.string() + ": " + problem;
            });
}

// One option of each stage: that stage and later ones are computed, no earlier one.
TEST_F(Trials, InvalidationMatrix) {
  const std::vector<std::pair<std::string, std::string>> options = {
      {"calib", "[calib]\nmin-corners = 9\n"},
      {"rectify", "[rectify]\nfilter = \"soft\"\n"},
      {"fit", ""},
      {"refine", ""},
      {"export", ""},
      {"report", "[report]\npicture-px = 300\n"}};
  RunTrials(
      "a changed option of each stage: it and later stages are computed, no "
      "earlier one",
      static_cast<int>(kStages.size()), [&](int i) {
        const auto& [stage, toml] = options[static_cast<size_t>(i)];
        Reset();
        if (stage == "fit") EditToml("iterations = 12", "iterations = 13");
        if (stage == "refine") EditToml("iterations = 8", "iterations = 9");
        if (stage == "export") EditToml("[export]\n", "[export]\nbits = \"16\"\n");
        WriteAll(capture() / "capture.toml", ReadAll(capture() / "capture.toml") + toml);
        const Outcome outcome = RunCapture({"--json"});
        if (outcome.code != 0) return outcome.err;
        const Json json = Json::parse(outcome.out);
        std::string problem;
        for (size_t k = 0; k < kStages.size(); ++k) {
          for (const Json& ran : json["stages"]) {
            if (ran["stage"] != kStages[k]) continue;
            const bool computed = ran["state"] == "computed";
            if (k == static_cast<size_t>(i) && !computed) problem += stage + " was not computed; ";
            if (k < static_cast<size_t>(i) && computed) problem += kStages[k] + " was computed; ";
          }
        }
        Reset();
        return problem;
      });
}

TEST_F(Trials, MutatedImages) {
  for (const auto& [target, path] :
       {std::pair{"rectified_image", "rectify"}, std::pair{"svbrdf", "refine/svbrdf.exr"}}) {
    fs::path file = capture() / "glint" / path;
    if (fs::is_directory(file)) {
      std::set<fs::path> images;
      for (const auto& entry : fs::recursive_directory_iterator(file)) {
        if (entry.path().extension() == ".exr") images.insert(entry.path());
      }
      file = *images.begin();
    }
    const std::string original = ReadAll(file);
    double longest_s = 0;
    RunTrials("an EXR with bytes changed, inserted or removed (" + std::string(target) +
                  "): read or refused within 10 s",
              600, [&, target = target](int) {
                std::string bytes = original;
                for (int changes = 1 + static_cast<int>(random_() % 4); changes > 0; --changes) {
                  // By turns in the header, whose bytes decide about the others, and anywhere.
                  const size_t place =
                      random_() % std::min<size_t>(bytes.size(), changes % 2 ? 1024 : bytes.size());
                  switch (random_() % 3) {
                    case 0:
                      bytes[place] = static_cast<char>(random_());
                      break;
                    case 1:
                      bytes.erase(place, 1 + random_() % 8);
                      break;
                    default:
                      bytes.insert(place,
                                   bytes.substr(random_() % bytes.size(), 1 + random_() % 16));
                  }
                }
                const auto start = Clock::now();
                fuzz::Accepts(fuzz::FindFuzzTarget(target), folder(), bytes);
                const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
                longest_s = std::max(longest_s, seconds);
                return seconds < 10 ? "" : std::to_string(seconds) + " s";
              });
    std::printf("(%s: longest %.3f s)\n", target, longest_s);
  }
}

TEST_F(Trials, DecimalComma) {
  const fs::path locale = folder() / "locale/de_DE.UTF-8";
  fs::create_directories(locale.parent_path());
  RunTrials("a locale with decimal commas (de_DE.UTF-8): the same bytes", 1, [&](int) {
    const Outcome made = RunProgram({"localedef", "-i", "de_DE", "-f", "UTF-8", locale});
    if (!fs::exists(locale)) return "localedef: " + made.err;
    fs::remove_all(capture() / "glint");
    const Outcome outcome = RunProgram(Run(), [&] {
      ::setenv("LOCPATH", locale.parent_path().c_str(), 1);
      ::setenv("LC_ALL", "de_DE.UTF-8", 1);
    });
    if (outcome.code != 0) return outcome.err;
    return Differences(Results(finished()), Results(capture()));
  });
}

TEST_F(Trials, Clock) {
  RunTrials(
      "files dated years ahead or in 1970, as after a clock change: everything stale is computed, "
      "and nothing else",
      4, [&](int i) {
        const auto shift = std::chrono::hours(24 * 365 * (i % 2 == 0 ? 3 : -50));
        for (const fs::path& photo : Photos())
          fs::last_write_time(photo, fs::file_time_type::clock::now() + shift);
        if (i >= 2) {
          fs::last_write_time(capture() / "glint/fit/manifest.json",
                              fs::file_time_type::clock::now() - shift);
        }
        const Outcome outcome = RunCapture({"--json"});
        if (outcome.code != 0) return outcome.err;
        for (const Json& stage : Json::parse(outcome.out)["stages"]) {
          if (stage["state"] == "computed") return "computed: " + stage["stage"].get<std::string>();
        }
        // Another photograph under the old name and date.
        const auto photos = Photos();
        const auto time = fs::last_write_time(photos[0]);
        fs::copy_file(photos[1], photos[0], fs::copy_options::overwrite_existing);
        fs::last_write_time(photos[0], time);
        const Outcome changed = RunCapture({"--json"});
        if (changed.code != 0) return changed.err;
        const bool noticed = Json::parse(changed.out)["stages"][0]["state"] == "computed";
        Reset();
        return noticed ? std::string() : std::string("another photograph was not noticed");
      });
}

TEST_F(Trials, ManyPhotographs) {
  constexpr int kPhotographs = 5000;
  const auto photos = Photos();
  for (int i = 0; i < kPhotographs; ++i) {
    fs::create_hard_link(
        photos[static_cast<size_t>(i) % photos.size()],
        capture() / "photos" / ("more_" + std::to_string(i) + photos[0].extension().string()));
  }
  RunTrials(
      "5,000 photographs: listed, hashed and reported as stale, and the run time predicted", 1,
      [&](int) {
        const auto start = Clock::now();
        const Outcome status = RunProgram({Program(kDriver), "status", capture()});
        const Outcome estimate = RunProgram({Program(kDriver), "estimate", capture(), "--json"});
        std::printf("(5,000 photographs: %.1f s)\n",
                    std::chrono::duration<double>(Clock::now() - start).count());
        if (status.code > 1) return status.err;
        if (estimate.code != 0) return estimate.err;
        const int counted = Json::parse(estimate.out)["photographs"];
        return counted == kPhotographs + static_cast<int>(photos.size())
                   ? std::string()
                   : "counted " + std::to_string(counted);
      });
}

}  // namespace
}  // namespace glint::test
