// A running Studio: who may come in, and that nothing else is served.
#include <gtest/gtest.h>

#include "base/errors/errors.h"
#include "tests/studio/studio_fixture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::Answer;
using test::Ask;
using test::RequestText;
using test::RunningStudio;

TEST(Server, NothingIsToldWithoutTheSecret) {
  const RunningStudio running;
  const int port = running.studio->port();
  const std::string host = running.page->host();
  for (const char* path : {"/", "/api/studio", "/api/library", "/api/events", "/api/captures/x"}) {
    EXPECT_EQ(Ask(port, RequestText("GET", path, {{"Host", host}})).status, 401) << path;
  }
  const std::string wrong = running.page->cookie().substr(0, 20) + "0000";
  EXPECT_EQ(
      Ask(port, RequestText("GET", "/api/library", {{"Host", host}, {"Cookie", wrong}})).status,
      401);
  EXPECT_EQ(Ask(port, RequestText("GET", "/?t=0000", {{"Host", host}})).status, 401);
  const std::string right = "/?t=" + running.page->token();
  EXPECT_EQ(Ask(port, RequestText("GET", right, {{"Host", host}})).status, 303);
  EXPECT_EQ(running.page->Get("/api/studio").status, 200);
}

TEST(Server, ReboundNamesAndOtherSitesAreRefused) {
  const RunningStudio running;
  const int port = running.studio->port();
  test::Headers headers = running.page->OwnHeaders();
  headers[0].second = "evil.example:" + std::to_string(port);
  EXPECT_EQ(Ask(port, RequestText("GET", "/api/library", headers)).status, 421);
  headers = running.page->OwnHeaders();
  headers[2].second = "http://evil.example";
  EXPECT_EQ(Ask(port, RequestText("POST", "/api/boards", headers, "{}")).status, 403);
  headers = running.page->OwnHeaders();
  headers.pop_back();
  EXPECT_EQ(Ask(port, RequestText("POST", "/api/boards", headers, "{}")).status, 403);
  headers = running.page->OwnHeaders();
  headers.erase(headers.begin() + 2);
  EXPECT_EQ(Ask(port, RequestText("POST", "/api/boards", headers, "{}")).status, 403);
  headers = running.page->OwnHeaders();
  headers.emplace_back("Sec-Fetch-Site", "cross-site");
  EXPECT_EQ(Ask(port, RequestText("POST", "/api/boards", headers, "{}")).status, 403);
  EXPECT_FALSE(fs::exists(running.folder / ".glint-studio/boards/A4"));
}

TEST(Server, EveryReplyForbidsWhatThePageDoesNotNeed) {
  const RunningStudio running;
  for (const char* path : {"/", "/api/studio", "/api/nothing", "/studio.css"}) {
    const std::string head = running.page->Get(path).head;
    EXPECT_NE(head.find("Content-Security-Policy: default-src 'self'"), std::string::npos) << path;
    EXPECT_NE(head.find("X-Content-Type-Options: nosniff"), std::string::npos) << path;
    EXPECT_EQ(head.find("Access-Control-Allow"), std::string::npos) << path;
  }
}

TEST(Server, NoPathOfAClientReachesTheFileSystem) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.folder.Write("wood/glint/report/index.html", "<p>report");
  running.folder.Write("wood/glint/export/manifest.json", "{}");
  running.folder.Write("wood/glint/refine/manifest.json", "{}");
  running.folder.Write("wood/glint/refine/svbrdf.exr", "maps");
  running.folder.Write("secret.txt", "secret");
  fs::create_symlink(running.folder / "secret.txt", running.folder / "wood/glint/export/link.png");
  fs::create_directory_symlink(running.folder.path(), running.folder / "wood/glint/export/all");
  fs::create_directory_symlink(running.folder.path(), running.folder / "wood/glint/tile");
  const std::string page = running.Capture(id)["result"]["page"];
  EXPECT_EQ(running.page->Get(page).body, "<p>report");
  const std::string base = page.substr(0, page.find("report/"));
  EXPECT_EQ(running.page->Get(base + "refine/manifest.json").body, "{}");  // the report's link
  EXPECT_EQ(running.page->Get(base + "refine/svbrdf.exr").status, 404);
  for (const std::string& path :
       {base + "../secret.txt", base + "export/../../../secret.txt",
        base + "%2e%2e/%2e%2e/secret.txt", base + "export%2f..%2f..%2f..%2fsecret.txt",
        base + "export/link.png", base + "export/all/secret.txt", base + "tile/secret.txt",
        base + "/" + (running.folder / "secret.txt").string(), base + "report/index.html%00.png",
        base + "..\\..\\secret.txt", std::string("/../../../../etc/passwd"),
        std::string("//etc/passwd"), std::string("/api/captures/..%2f..%2fetc/thumbnail"),
        std::string("/files/0123456789abcdef0123456789abcdef/") + id + "/report/index.html"}) {
    const Answer answer = running.page->Get(path);
    EXPECT_GE(answer.status, 400) << path;
    EXPECT_EQ(answer.body.find("secret"), std::string::npos) << path;
  }
}

TEST(Server, AReportRunsAsAPageOfNowhere) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.folder.Write("wood/glint/report/index.html", "<p>report");
  const Answer answer = running.page->Get(running.Capture(id)["result"]["page"]);
  EXPECT_NE(answer.head.find("Content-Security-Policy: sandbox"), std::string::npos);
  EXPECT_EQ(answer.head.find("allow-same-origin"), std::string::npos);
}

TEST(Server, MalformedRequestsAreAnsweredOrDroppedAndStudioGoesOn) {
  const RunningStudio running;
  const int port = running.studio->port();
  const std::string host = "Host: " + running.page->host() + "\r\n";
  for (const std::string& bytes :
       {std::string("\r\n\r\n"), std::string("GET\r\n\r\n"), std::string("\0\0\0\0\r\n\r\n", 8),
        "GET / HTTP/9.9\r\n" + host + "\r\n", "PATCH /api/boards HTTP/1.1\r\n" + host + "\r\n",
        "OPTIONS * HTTP/1.1\r\n" + host + "\r\n",
        "GET /" + std::string(5000, 'a') + " HTTP/1.1\r\n" + host + "\r\n",
        "GET / HTTP/1.1\r\nX: " + std::string(100000, 'a') + "\r\n\r\n",
        "POST /api/boards HTTP/1.1\r\n" + host + "Content-Length: -1\r\n\r\n",
        "POST /api/boards HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\nZZZ\r\n"}) {
    const int status = Ask(port, bytes).status;
    EXPECT_TRUE(status == 0 || status >= 400) << bytes.substr(0, 40);
  }
  EXPECT_EQ(running.page->Get("/api/studio").status, 200);
}

TEST(Server, LargeOrWrongJsonIsRefused) {
  const RunningStudio running;
  const std::string long_text(2 << 20, 'a');
  EXPECT_EQ(running.page->Post("/api/captures", {{"name", long_text}}).status, 413);
  EXPECT_EQ(running.page->Send("POST", "/api/captures", Json::array()).status, 400);
  EXPECT_EQ(running.page->Post("/api/captures", {{"name", 3}}).status, 422);
  EXPECT_EQ(running.page->Post("/api/captures", {{"name", "a"}, {"size_mm", {1}}}).status, 422);
  EXPECT_EQ(running.page->Post("/api/boards", {{"paper", "--help"}}).status, 422);
  EXPECT_EQ(running.page->Post("/api/boards", {{"paper", "../../x"}}).status, 422);
}

TEST(Server, CapturesAreMadeUnderPlainNamesAndOnce) {
  const RunningStudio running;
  const std::string id = running.MakeCapture("../Wood & more");
  EXPECT_FALSE(id.empty());
  const Json list = running.page->Get("/api/library").json()["captures"];
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["status"], "empty");
  const std::string name = list[0]["name"];
  EXPECT_TRUE(fs::exists(running.folder / name / "capture.toml"));
  EXPECT_EQ(name.find('/'), std::string::npos);
  EXPECT_EQ(running.MakeCapture("../Wood & more"), "");
  const Json board = running.page->Get("/api/boards").json()["boards"][0];
  const Answer large = running.page->Post(
      "/api/captures",
      {{"name", "b"}, {"kind", "board"}, {"size_mm", {500, 500}}, {"board", board["id"]}});
  EXPECT_EQ(large.status, 422);
  EXPECT_NE(large.json()["error"]["remedy"], "");
  EXPECT_EQ(running.page->Get("/api/boards/" + board["id"].get<std::string>() + "/board.pdf")
                .body.substr(0, 4),
            "%PDF");
}

TEST(Server, AMeasuredRulerCorrectsTheBoard) {
  const RunningStudio running;
  const Json board = running.page->Post("/api/boards", {{"paper", "A4"}}).json();
  const std::string path = "/api/boards/" + board["id"].get<std::string>();
  const Json measured = running.page->Send("PUT", path, {{"ruler_measured_mm", 149.0}}).json();
  EXPECT_NEAR(measured["ruler_mm"].get<double>(), 149, 1e-6);
  EXPECT_EQ(running.page->Send("PUT", path, {{"ruler_measured_mm", 3.0}}).status, 422);
}

TEST(Server, ATrashedCaptureIsMovedWhole) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.folder.Write("wood/photos/a.jpg", test::JpegBytes(1));
  EXPECT_EQ(running.page->Post("/api/captures/" + id + "/trash").status, 200);
  EXPECT_EQ(running.page->Get("/api/captures/" + id).status, 404);
  const fs::path trash = running.folder / ".glint-trash";
  ASSERT_NE(fs::directory_iterator(trash), fs::directory_iterator());
  const fs::path kept = fs::directory_iterator(trash)->path();
  EXPECT_TRUE(kept.filename().string().starts_with("wood-"));
  EXPECT_EQ(test::ReadAll(kept / "photos/a.jpg"), test::JpegBytes(1));
}

TEST(Server, ACaptureTomlThatAPersonBrokeIsShownAndNotTouched) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  running.folder.Write("wood/capture.toml", "[sample\nsize_mm = 3\n");
  const Json capture = running.Capture(id);
  EXPECT_EQ(capture["status"], "failed");
  EXPECT_NE(capture["problem"]["message"].get<std::string>().find("capture.toml"),
            std::string::npos);
  EXPECT_GE(
      running.page->Upload("/api/captures/" + id + "/photographs", {{"a.jpg", test::JpegBytes(1)}})
          .status,
      200);
  EXPECT_FALSE(fs::exists(running.folder / "wood/photos/a.jpg"));
  EXPECT_EQ(test::ReadAll(running.folder / "wood/capture.toml"), "[sample\nsize_mm = 3\n");
}

TEST(Server, ASecondStudioOfTheFolderIsRefused) {
  const RunningStudio running;
  StudioOptions options;
  options.folder = running.folder.path();
  options.port = 0;
  EXPECT_THROW(Studio second(options), UserError);
}

TEST(Server, ATakenPortIsToldWithARemedy) {
  const RunningStudio running;
  const test::TemporaryFolder other;
  StudioOptions options;
  options.folder = other.path();
  options.port = running.studio->port();
  try {
    const Studio second(options);
    FAIL();
  } catch (const EnvironmentError& error) {
    EXPECT_NE(std::string(error.what()).find("--port"), std::string::npos);
  }
}

struct Phone {
  int port = 0;
  std::string path, host;  // "/p/TOKEN"
};

Phone OpenPhone(const RunningStudio& running, const std::string& id) {
  const Json link = running.page->Post("/api/captures/" + id + "/phone").json();
  const std::string url = link["url"];
  const size_t slash = url.find('/', 7), colon = url.rfind(':', slash);
  return {std::atoi(url.c_str() + colon + 1), url.substr(slash), url.substr(7, slash - 7)};
}

TEST(Phone, ALinkReachesItsCaptureAndNothingElse) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  const Phone phone = OpenPhone(running, id);
  EXPECT_NE(phone.port, running.studio->port());
  const auto get = [&](const std::string& path) {
    return Ask(phone.port, RequestText("GET", path, {{"Host", phone.host}})).status;
  };
  EXPECT_EQ(get(phone.path + "/state"), 200);
  for (const std::string& path :
       {std::string("/"), std::string("/?t=" + running.page->token()), std::string("/api/library"),
        "/api/captures/" + id, phone.path + "/../api/library", phone.path + "/photographs",
        std::string("/p/0123456789abcdef0123456789abcdef/state"), std::string("/p//state")}) {
    EXPECT_GE(get(path), 400) << path;
  }
  // Nor does the browser's cookie open this door.
  EXPECT_GE(Ask(phone.port, RequestText("GET", "/api/library",
                                        {{"Host", phone.host}, {"Cookie", running.page->cookie()}}))
                .status,
            400);
}

TEST(Phone, PhotographsComeInThroughTheLinkUntilItIsClosed) {
  const RunningStudio running;
  const std::string id = running.MakeCapture();
  const Phone phone = OpenPhone(running, id);
  const test::Headers headers = {{"Host", phone.host},
                                 {"Origin", "http://" + phone.host},
                                 {"X-Glint", "1"},
                                 {"Content-Type", "multipart/form-data; boundary=between-parts"}};
  const std::string upload =
      RequestText("POST", phone.path + "/photographs", headers,
                  test::PageClient::Multipart({{"image.jpg", test::JpegBytes(1)}}));
  EXPECT_EQ(Ask(phone.port, upload).status, 200);
  EXPECT_EQ(running.CheckedCapture(id)["photographs"].size(), 1u);
  EXPECT_EQ(running.page->Send("DELETE", "/api/captures/" + id + "/phone", Json::object()).status,
            200);
  EXPECT_EQ(Ask(phone.port, upload).status, 410);
}

TEST(Phone, AnExpiredLinkIsRefused) {
  StudioOptions options;
  options.phone_idle_s = 0.2;
  const RunningStudio running(options);
  const Phone phone = OpenPhone(running, running.MakeCapture());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(
      Ask(phone.port, RequestText("GET", phone.path + "/state", {{"Host", phone.host}})).status,
      410);
}

TEST(Lan, BrowsersOfTheNetworkComeInByASecretOfTheirOwn) {
  StudioOptions options;
  options.lan = true;
  const RunningStudio running(options);
  const test::PageClient far(running.studio->lan_address());
  EXPECT_NE(far.port(), running.page->port());
  EXPECT_NE(far.token(), running.page->token());
  EXPECT_EQ(far.Get("/api/library").status, 200);
  const test::Headers near_cookie = {{"Host", far.host()}, {"Cookie", running.page->cookie()}};
  EXPECT_EQ(Ask(far.port(), RequestText("GET", "/api/library", near_cookie)).status, 401);
  // Nor do they open windows on the machine that Studio runs on.
  const std::string id = running.MakeCapture();
  EXPECT_EQ(far.Post("/api/captures/" + id + "/open-folder").status, 403);
}

TEST(Lan, WithoutItNoSecondAddressIsOpen) {
  const RunningStudio running;
  EXPECT_EQ(running.studio->lan_address(), "");
}

}  // namespace
}  // namespace glint
