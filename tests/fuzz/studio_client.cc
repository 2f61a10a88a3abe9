#include "tests/fuzz/studio_client.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/errors/errors.h"
#include "base/formats/board_file.h"
#include "base/formats/capture.h"
#include "pipeline/studio/captures/library.h"
#include "pipeline/studio/studio.h"
#include "tests/studio/http_client.h"
#include "tests/studio/picture.h"
#include "tests/support/process.h"

namespace glint::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr char kNext[] = "\n== NEXT\n";
constexpr size_t kMostRequests = 6;
constexpr double kPatience_s = 20;  // sanitizers make everything slow
constexpr char kSecret[] = "what lies outside the folder that Studio serves";

constexpr char kCaptureToml[] = R"([sample]
size_mm = [90, 90]
resolution_px = 64
[photos]
files = ["photos/*.jpg"]
[board]
kind = "charuco"
squares = [13, 17]
square_mm = 15
marker_mm = 11
window = [3, 5, 7, 7]
[export]
name = "wood"
)";

// Studio's folder, with a capture that has a photograph and results, and a board. Around it there
// are only folders on the way to it and a secret.
class Folder {
 public:
  Folder() {
    test::WriteAll(way_ / "secret.txt", kSecret);
    WriteCapture();
    const Capture capture = ReadCapture(path() / "wood");
    test::WriteAll(path() / ".glint-studio/boards/A4/board.json",
                   ToJson(BoardFile{capture.board, std::nullopt}).dump());
    test::WriteAll(path() / ".glint-studio/boards/A4/board.pdf", "%PDF");
  }

  fs::path path() const { return way_ / "studio"; }

  // As it was at the beginning, but for what Studio is still writing: the next time removes that.
  void Restore() const {
    const fs::path wood = path() / "wood";
    RemoveAllBut(path(), {"wood", ".glint-studio"});
    RemoveAllBut(wood, {"capture.toml", "glint", "photos"});
    RemoveAllBut(wood / "photos", {"a.jpg"});
    if (test::ReadAll(wood / "capture.toml") != kCaptureToml ||
        !fs::exists(wood / "photos/a.jpg") || !fs::exists(wood / "glint/report/index.html")) {
      WriteCapture();
    }
  }

  void CheckSurroundings() const {
    if (NamesIn(root_.path()) != Names{"a"} || NamesIn(root_ / "a") != Names{"b"} ||
        NamesIn(way_) != Names{"secret.txt", "studio"} ||
        test::ReadAll(way_ / "secret.txt") != kSecret) {
      throw std::logic_error("something was written outside the folder that Studio serves");
    }
  }

 private:
  using Names = std::set<std::string>;

  static Names NamesIn(const fs::path& folder) {
    Names names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      names.insert(entry.path().filename());
    }
    return names;
  }

  static void RemoveAllBut(const fs::path& folder, const Names& names) {
    std::error_code error;
    for (const std::string& name : NamesIn(folder)) {
      if (!names.contains(name)) fs::remove_all(folder / name, error);
    }
  }

  void WriteCapture() const {
    const fs::path wood = path() / "wood";
    test::WriteAll(wood / "capture.toml", kCaptureToml);
    test::WriteAll(wood / "photos/a.jpg", test::JpegBytes(1, 64, 48));
    test::WriteAll(wood / "glint/report/index.html", "<p>report");
    test::WriteAll(wood / "glint/export/wood_basecolor.png", "a map");
    test::WriteAll(wood / "glint/export/manifest.json",
                   R"({"data": {"maps": [{"map": "basecolor", "file": "wood_basecolor.png"}]}})");
    test::WriteAll(wood / "glint/.studio/run.json",
                   R"({"state": "done", "quick": false, "share": 1, "stages": [],
                       "message": null, "remedy": null})");
  }

  const test::TemporaryFolder root_;
  const fs::path way_ = root_ / "a/b";
};

StudioOptions OptionsOf(const Folder& folder) {
  StudioOptions options;
  options.folder = folder.path();
  options.port = 0;
  options.lan = true;
  options.lan_addresses = {"127.0.0.1"};
  options.check_threads = 1;
  options.version = "test";
  return options;
}

class StudioUnderTest {
 public:
  StudioUnderTest()
      : studio_(OptionsOf(folder_)), page_(studio_.address()), lan_(studio_.lan_address()) {
    const Json result = page_.Get(CapturePath()).json().value("result", Json::object());
    const std::string report = result.value("page", "");
    files_ = report.substr(0, report.find("/report/"));
    WaitForCheck();
  }

  bool is_worn_out() const { return requests_ > kMostOfOneStudio || streams_ > kMostStreams; }

  // Whether it was answered with success.
  bool Send(const std::string& text) {
    ++requests_;
    const bool to_lan = text.find("{LAN_HOST}") != std::string::npos;
    const test::Answer answer = Exchange(to_lan ? lan_.port() : page_.port(), Filled(text));
    if (answer.body.find(kSecret) != std::string::npos) {
      throw std::logic_error("Studio told what lies outside its folder");
    }
    return answer.status >= 200 && answer.status < 400;
  }

  void CheckAndRestore() const {
    if (page_.Get("/api/studio").status != 200) {
      throw std::logic_error("Studio no longer answers");
    }
    folder_.CheckSurroundings();
    folder_.Restore();
  }

 private:
  static constexpr int kMostOfOneStudio = 2000, kMostStreams = 100;

  // Of the photograph that is there from the beginning.
  void WaitForCheck() const {
    std::string state = "waiting";
    while (state == "waiting" || state == "checking") {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      state = page_.Get(CapturePath()).json()["photographs"][0].value("state", "");
    }
  }

  static std::string CapturePath() { return "/api/captures/" + IdOf("wood"); }

  // What stands for each name in a request, but {LENGTH}: that of its body.
  std::string ValueOf(const std::string& name) const {
    static const std::map<std::string, std::function<std::string(const StudioUnderTest&)>> values =
        {{"HOST", [](const auto& self) { return self.page_.host(); }},
         {"COOKIE", [](const auto& self) { return self.page_.cookie(); }},
         {"TOKEN", [](const auto& self) { return self.page_.token(); }},
         {"LAN_HOST", [](const auto& self) { return self.lan_.host(); }},
         {"LAN_COOKIE", [](const auto& self) { return self.lan_.cookie(); }},
         {"CAPTURE", [](const auto&) { return IdOf("wood"); }},
         {"SINGLE", [](const auto&) { return IdOf("single"); }},  // once a request has made it
         {"OTHER", [](const auto&) { return IdOf("other"); }},    // the same
         {"PHOTO", [](const auto&) { return IdOf("photos/a.jpg"); }},
         {"BOARD", [](const auto&) { return IdOf("A4"); }},
         {"FILES", [](const auto& self) { return self.files_; }},
         {"PHONE", [](const auto& self) { return self.PhoneLink(); }},
         {"JPEG", [](const auto&) { return test::JpegBytes(2, 64, 48); }}};
    const auto found = values.find(name);
    return found == values.end() ? "{" + name + "}" : found->second(*this);
  }

  // "/p/TOKEN", a new one.
  std::string PhoneLink() const {
    const Json link = page_.Post(CapturePath() + "/phone").json();
    const std::string url = link.value("url", "");
    const size_t path = url.find("/p/");
    return path == std::string::npos ? "" : url.substr(path);
  }

  std::string Filled(const std::string& text) const {
    constexpr size_t kMostOfName = 12;
    std::string filled;
    for (size_t at = 0; at < text.size();) {
      const size_t end = text[at] == '{' ? text.find('}', at) : std::string::npos;
      if (end == std::string::npos || end - at > kMostOfName) {
        filled += text[at++];
        continue;
      }
      filled += ValueOf(text.substr(at + 1, end - at - 1));
      at = end + 1;
    }
    return WithLength(filled);
  }

  static std::string WithLength(std::string request) {
    constexpr std::string_view kName = "{LENGTH}";
    const size_t head = request.find("\r\n\r\n"), at = request.find(kName);
    if (head == std::string::npos || at == std::string::npos || at > head) return request;
    const size_t body_bytes = request.size() - head - 4;
    return request.replace(at, kName.size(), std::to_string(body_bytes));
  }

  // Nothing more is to come, so that Studio need not wait for it. Of a stream of events, only the
  // beginning is read.
  test::Answer Exchange(int port, const std::string& bytes) {
    const int socket = test::Connect(port);
    if (socket < 0) {
      throw std::logic_error(std::string("Studio no longer accepts connections: ") +
                             std::strerror(errno));
    }
    test::SendAll(socket, bytes);
    ::shutdown(socket, SHUT_WR);
    std::string reply;
    char piece[16384];
    bool is_stream = false;
    while (!is_stream) {
      if (!test::IsReadable(socket, kPatience_s)) {
        throw std::logic_error("Studio neither answers nor closes the connection");
      }
      const ssize_t count = ::recv(socket, piece, sizeof piece, 0);
      if (count <= 0) break;
      reply.append(piece, static_cast<size_t>(count));
      is_stream = reply.find("Content-Type: text/event-stream\r\n") < reply.find("\r\n\r\n");
    }
    ::close(socket);
    streams_ += is_stream ? 1 : 0;
    return test::Parsed(reply);
  }

  const Folder folder_;
  const Studio studio_;
  const test::PageClient page_, lan_;
  std::string files_;  // what results' addresses begin with
  int requests_ = 0, streams_ = 0;
};

std::unique_ptr<StudioUnderTest>& TheStudio() {
  static auto* const studio = new std::unique_ptr<StudioUnderTest>;
  return *studio;
}

StudioUnderTest& RunningStudio() {
  std::unique_ptr<StudioUnderTest>& studio = TheStudio();
  const bool is_first = !studio;
  if (is_first || studio->is_worn_out()) {
    ::setenv("BROWSER", "no program", 1);  // folders are not to open on the desktop
    studio.reset();
    studio = std::make_unique<StudioUnderTest>();
  }
  // At the end its threads are to stop before what they use is gone. All of that is there now.
  if (is_first) std::atexit([] { TheStudio().reset(); });
  return *studio;
}

std::vector<std::string> RequestsIn(std::string_view bytes) {
  std::vector<std::string> requests;
  while (requests.size() < kMostRequests) {
    const size_t end = bytes.find(kNext);
    requests.emplace_back(bytes.substr(0, end));
    if (end == std::string_view::npos) break;
    bytes.remove_prefix(end + sizeof kNext - 1);
  }
  return requests;
}

}  // namespace

void SendToStudio(std::string_view bytes) {
  StudioUnderTest& studio = RunningStudio();
  bool all_good = true;
  for (const std::string& request : RequestsIn(bytes)) all_good &= studio.Send(request);
  studio.CheckAndRestore();
  if (!all_good) throw UserError("a request was refused");
}

}  // namespace glint::fuzz
