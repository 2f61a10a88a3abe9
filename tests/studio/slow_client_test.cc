// Slow and stuck clients hold nobody up, and are let go of.
#include <gtest/gtest.h>

#include "tests/studio/studio_fixture.h"

namespace glint {
namespace {

using Clock = std::chrono::steady_clock;
using test::RunningStudio;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

StudioOptions Impatient() {
  StudioOptions options;
  options.deadlines.head_s = 1.5;
  options.deadlines.body_s = 1.5;
  options.deadlines.silence_s = 1.5;
  return options;
}

TEST(SlowClients, TwoHundredThatSendTheirHeadByteByByteHoldNobodyUp) {
  const RunningStudio running(Impatient());
  std::vector<int> slow;
  for (int i = 0; i < 200; ++i) {
    slow.push_back(test::Connect(running.studio->port()));
    ASSERT_GE(slow.back(), 0);
    test::SendAll(slow.back(), "GET / HTTP/1.1\r\nHo");
  }
  const auto begin = Clock::now();
  EXPECT_EQ(running.page->Get("/api/studio").status, 200);
  EXPECT_LT(SecondsSince(begin), 1);
  // However they drip, the deadline is for the whole head.
  while (SecondsSince(begin) < 2.5) {
    for (const int socket : slow) test::SendAll(socket, "s");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  int let_go = 0;
  for (const int socket : slow) {
    let_go += test::SendAll(socket, "s") && test::SendAll(socket, "s") ? 0 : 1;
    ::close(socket);
  }
  EXPECT_EQ(let_go, 200);
}

TEST(SlowClients, ABodyThatDoesNotComeIsGivenUp) {
  const RunningStudio running(Impatient());
  const std::string id = running.MakeCapture();
  std::string upload = running.page->UploadText("/api/captures/" + id + "/photographs",
                                                {{"a.jpg", test::JpegBytes(1)}});
  const int socket = test::Connect(running.studio->port());
  test::SendAll(socket, upload.substr(0, upload.size() - 1000));
  const auto begin = Clock::now();
  test::ReceiveAll(socket);
  EXPECT_LT(SecondsSince(begin), 8);
  ::close(socket);
  EXPECT_EQ(running.Capture(id)["photographs"].size(), 0u);
  const auto photos = running.folder / "wood/photos";
  EXPECT_EQ(std::filesystem::directory_iterator(photos), std::filesystem::directory_iterator());
}

TEST(SlowClients, ManyEventStreamsLeaveRoomForRequests) {
  const RunningStudio running;
  std::vector<int> streams;
  for (int i = 0; i < 50; ++i) {
    streams.push_back(test::Connect(running.studio->port()));
    test::SendAll(streams.back(), test::RequestText("GET", "/api/events",
                                                    {{"Host", running.page->host()},
                                                     {"Cookie", running.page->cookie()}}));
  }
  const auto begin = Clock::now();
  const std::string id = running.MakeCapture();
  EXPECT_LT(SecondsSince(begin), 5);
  // Each hears of the new capture.
  for (const int socket : streams) {
    std::string heard;
    char bytes[4096];
    while (heard.find(id) == std::string::npos) {
      const ssize_t count = ::recv(socket, bytes, sizeof bytes, 0);
      ASSERT_GT(count, 0);
      heard.append(bytes, static_cast<size_t>(count));
    }
    EXPECT_NE(heard.find("event: change\ndata: {\"what\":\"library\""), std::string::npos);
    ::close(socket);
  }
}

TEST(SlowClients, StudioEndsAtOnceThoughStreamsAreOpen) {
  auto running = std::make_unique<RunningStudio>();
  const int socket = test::Connect(running->studio->port());
  test::SendAll(socket, test::RequestText("GET", "/api/events",
                                          {{"Host", running->page->host()},
                                           {"Cookie", running->page->cookie()}}));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const auto begin = Clock::now();
  running->studio.reset();
  EXPECT_LT(SecondsSince(begin), 3);
  ::close(socket);
}

}  // namespace
}  // namespace glint
