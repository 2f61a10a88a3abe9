#include "pipeline/studio/access/phone_links.h"

#include <gtest/gtest.h>

#include <thread>

namespace glint {
namespace {

TEST(PhoneLinks, ALinkReachesItsCaptureUntilItIsClosed) {
  PhoneLinks links;
  const PhoneLink link = links.Open("wood");
  ASSERT_TRUE(links.Use(link.token, "10.0.0.2"));
  EXPECT_EQ(links.Use(link.token, "10.0.0.2")->capture, "wood");
  EXPECT_FALSE(links.Use("", "10.0.0.2"));
  EXPECT_FALSE(links.Use(link.token.substr(1), "10.0.0.2"));
  links.Close("wood");
  EXPECT_FALSE(links.Use(link.token, "10.0.0.2"));
}

TEST(PhoneLinks, ALinkBelongsToThePhoneThatOpensItFirst) {
  PhoneLinks links;
  const PhoneLink link = links.Open("wood");
  EXPECT_TRUE(links.Use(link.token, "10.0.0.2"));
  EXPECT_FALSE(links.Use(link.token, "10.0.0.3"));
  EXPECT_TRUE(links.Use(link.token, "10.0.0.2"));
}

TEST(PhoneLinks, ANewLinkEndsTheEarlierOneOfItsCapture) {
  PhoneLinks links;
  const PhoneLink first = links.Open("wood"), other = links.Open("cloth");
  links.Open("wood");
  EXPECT_FALSE(links.IsValid(first.token));
  EXPECT_TRUE(links.IsValid(other.token));
}

TEST(PhoneLinks, LinksExpireWhenIdleAndInTheEnd) {
  PhoneLinks idle(0.05, 100), longest(100, 0.05);
  const PhoneLink a = idle.Open("wood"), b = longest.Open("wood");
  EXPECT_TRUE(longest.Use(b.token, "x"));
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_FALSE(idle.Use(a.token, "x"));
  EXPECT_FALSE(idle.Of("wood"));
  EXPECT_FALSE(longest.Use(b.token, "x"));
}

TEST(QrCode, IsAnSvgElement) {
  const std::string svg = QrSvg("http://192.168.1.2:40000/p/0123456789abcdef0123456789abcdef");
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>"));
}

}  // namespace
}  // namespace glint
