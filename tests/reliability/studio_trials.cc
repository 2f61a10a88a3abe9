// glint-studio killed while photographs arrive and while it runs the stages: ./dev reliability.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "base/errors/errors.h"
#include "base/formats/capture.h"
#include "tests/e2e/capture_fixture.h"
#include "tests/reliability/trials.h"
#include "tests/studio/http_client.h"
#include "tests/studio/picture.h"
#include "tests/studio/studio_process.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void Sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// In pieces, as over a network, so that there are moments between them.
Answer AskSlowly(int port, const std::string& bytes) {
  constexpr size_t kPiece_bytes = 16 << 10;
  constexpr double kPause_s = 5e-4;
  const int socket = Connect(port);
  if (socket < 0) return {};
  for (size_t at = 0; at < bytes.size(); at += kPiece_bytes) {
    if (!SendAll(socket, bytes.substr(at, kPiece_bytes))) break;
    Sleep(kPause_s);
  }
  const std::string reply = ReceiveAll(socket);
  ::close(socket);
  return Parsed(reply);
}

// What a kill may leave of a capture.toml: all of it, but for the lists of photographs.
std::string WithoutPhotoLists(const std::string& toml) {
  std::istringstream lines(toml);
  std::string rest;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("files =") && !line.starts_with("left_out =")) rest += line + "\n";
  }
  return rest;
}

class StudioTrials : public CaptureTest {
 protected:
  std::mt19937 random_{1};

  double Moment(double seconds) {
    return std::uniform_real_distribution<double>(0, seconds)(random_);
  }
  // By turns the process alone and with its process group.
  static void Kill(const StudioProcess& studio, int trial) {
    ::kill(trial % 2 == 0 ? studio.pid : -studio.pid, SIGKILL);
  }
  std::unique_ptr<StudioProcess> StartStudio() const {
    return std::make_unique<StudioProcess>(folder(), scratch_.path());
  }
  void Reset() const {
    fs::remove_all(capture());
    CopyCapture(finished(), capture());
  }
  // Empty where Studio was killed before it had answered.
  static Json ListIn(const Answer& answer, const std::string& key) {
    const Json json = answer.json();
    return json.is_object() ? json.value(key, Json::array()) : Json::array();
  }
  // "/api/captures/ID" of the only capture; empty: Studio lists none.
  static std::string PathOf(const PageClient& page) {
    const Json captures = ListIn(page.Get("/api/library"), "captures");
    return captures.size() == 1 ? "/api/captures/" + captures[0].value("id", "") : "";
  }
  static Json CaptureOf(const PageClient& page) { return page.Get(PathOf(page)).json(); }

 private:
  TemporaryFolder scratch_;
};

class StudioUploads : public StudioTrials {
 protected:
  // Bytes by name. Names are not kept where another photograph has them.
  using Photographs = std::map<std::string, std::string>;

  // Others in every trial; the last is of a kind that capture.toml does not list yet.
  Photographs Sent(int trial) const {
    Photographs sent;
    for (const fs::path& photo : Photos()) {
      std::string bytes = ReadAll(photo);
      bytes.insert(bytes.size() - 2, 1, static_cast<char>(trial));  // before JPEG's end marker
      sent["sent_" + photo.filename().string()] = bytes;
    }
    sent["small.png"] = PngBytes(trial);
    return sent;
  }

  // Sends all, one a request or all in one; the names that were answered with success.
  static std::set<std::string> Send(const PageClient& page, const Photographs& photographs,
                                    bool together) {
    const std::string path = PathOf(page) + "/photographs";
    std::vector<Headers> requests;
    for (const auto& photograph : photographs) {
      if (requests.empty() || !together) requests.emplace_back();
      requests.back().push_back(photograph);
    }
    std::set<std::string> confirmed;
    for (const Headers& request : requests) {
      const Answer answer = AskSlowly(page.port(), page.UploadText(path, request));
      if (answer.status != 200) break;
      for (const Json& one : ListIn(answer, "photographs")) {
        if (one.value("error", Json()).is_null()) confirmed.insert(one.value("name", ""));
      }
    }
    return confirmed;
  }

  // What is wrong with photos/, where all of `confirmed` and perhaps others of `sent` are.
  std::string ProblemOfFiles(const Photographs& sent,
                             const std::set<std::string>& confirmed) const {
    std::map<std::string, int> kept;  // by bytes
    for (const fs::path& file : Photos()) {
      if (file.filename().string()[0] != '.') ++kept[ReadAll(file)];
    }
    for (const auto& [name, bytes] : sent) {
      if (confirmed.contains(name) && !kept.contains(bytes)) return name + " is lost";
      if (kept.contains(bytes) && kept[bytes] != 1) return name + " is kept twice";
      kept.erase(bytes);
    }
    for (const auto& entry : fs::directory_iterator(finished() / "photos")) {
      if (kept.erase(ReadAll(entry.path())) == 0)
        return entry.path().filename().string() + " changed";
    }
    return kept.empty() ? "" : std::to_string(kept.size()) + " photographs that nobody sent whole";
  }

  std::string ProblemOfDescription() const {
    const std::string before = ReadAll(finished() / "capture.toml");
    const std::string now = ReadAll(capture() / "capture.toml");
    if (WithoutPhotoLists(now) != WithoutPhotoLists(before)) return "capture.toml: " + now;
    try {
      for (const std::string& place : ReadCapture(capture()).left_out_photos) {
        if (!fs::exists(capture() / place)) return place + " is left out, but not there";
      }
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  // Files of an interrupted upload or edit that the next Studio has not removed.
  std::string Leftovers() const {
    for (const auto& [path, bytes] : Sources(capture())) {
      const std::string name = fs::path(path).filename();
      if (name[0] == '.' || name.find(".tmp") != std::string::npos)
        return path + " was left behind";
    }
    return "";
  }

  // What the next Studio makes of things as they lie, once everything is sent again.
  std::string ProblemOfNext(const Photographs& sent) const {
    const auto next = StartStudio();
    if (next->address.empty()) return "Studio does not start: " + ReadAll(next->err);
    if (std::string left = Leftovers(); !left.empty()) return left;
    const PageClient page(next->address);
    if (const Json problem = CaptureOf(page)["problem"]; !problem.is_null()) return problem.dump();
    if (Send(page, sent, false).size() != sent.size()) return "a photograph sent again is refused";
    std::set<std::string> names;
    for (const auto& [name, bytes] : sent) names.insert(name);
    const size_t listed = CaptureOf(page)["photographs"].size();
    if (listed != Photos().size()) return "only " + std::to_string(listed) + " are listed";
    return ProblemOfFiles(sent, names);
  }
};

TEST_F(StudioUploads, KillStudio) {
  double seconds = 0;
  {
    const auto studio = StartStudio();
    ASSERT_FALSE(studio->address.empty()) << ReadAll(studio->err);
    const auto start = Clock::now();
    ASSERT_EQ(Send(PageClient(studio->address), Sent(0), false).size(), Sent(0).size());
    seconds = SecondsSince(start);
  }
  RunTrials(
      "`kill -9` of `glint studio` (alternately the process alone and its process group) while "
      "photographs are sent to it, at any moment: none is lost, torn or kept twice",
      50, [&](int i) -> std::string {
        Reset();
        const Photographs sent = Sent(i);
        std::set<std::string> confirmed;
        {
          const auto studio = StartStudio();
          if (studio->address.empty()) return "Studio does not start: " + ReadAll(studio->err);
          const PageClient page(studio->address);
          const double moment = Moment(seconds);
          std::jthread killer([&] {
            Sleep(moment);
            Kill(*studio, i);
          });
          confirmed = Send(page, sent, i / 2 % 2 == 1);
        }
        if (std::string problem = ProblemOfFiles(sent, confirmed); !problem.empty()) return problem;
        if (std::string problem = ProblemOfDescription(); !problem.empty()) return problem;
        return ProblemOfNext(sent);
      });
}

class StudioRuns : public StudioTrials {
 protected:
  static bool Run(const PageClient& page) {
    return page.Post(PathOf(page) + "/run", {{"quick", false}}).status == 200;
  }
  // How the run that Studio has begun ends.
  static std::string EndOfRun(const PageClient& page) {
    for (;;) {
      const Json run = CaptureOf(page).value("run", Json());
      if (!run.is_object()) return "no run";
      std::string state = run.value("state", "");
      if (state == "failed") return state + ": " + run.value("message", "");
      if (state != "running") return state;
      Sleep(0.1);
    }
  }
  std::string RunByStudio() const {
    const auto studio = StartStudio();
    if (studio->address.empty()) return "Studio does not start: " + ReadAll(studio->err);
    const PageClient page(studio->address);
    if (!Run(page)) return "the next Studio refuses to run it";
    const std::string state = EndOfRun(page);
    return state == "done" ? "" : "the next run: " + state;
  }
  std::string RunByItself() const {
    const Outcome outcome = RunCapture();
    return outcome.code == 0 ? "" : "the next run failed: " + outcome.err;
  }
};

TEST_F(StudioRuns, KillStudio) {
  RunTrials(
      "`kill -9` of `glint studio` (alternately the process alone and its process group) while it "
      "runs the stages, at any moment; the next run is alternately Studio's and `glint run`",
      50, [&](int i) -> std::string {
        fs::remove_all(capture() / "glint");
        const Tree before = Sources(capture());
        {
          const auto studio = StartStudio();
          if (studio->address.empty()) return "Studio does not start: " + ReadAll(studio->err);
          if (!Run(PageClient(studio->address))) return "Studio refuses to run it";
          Sleep(Moment(run_seconds()));
          Kill(*studio, i);
        }
        std::string problem = i / 2 % 2 == 0 ? RunByStudio() : RunByItself();
        if (!problem.empty()) return problem;
        return Differences(before, Sources(capture())) +
               Differences(Results(finished()), Results(capture()));
      });
}

}  // namespace
}  // namespace glint::test
