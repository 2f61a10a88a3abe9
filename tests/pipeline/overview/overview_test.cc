// The page about many captures.
#include "pipeline/overview/overview_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files/files.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using State = CaptureSummary::State;
using testing::HasSubstr;
using testing::Not;

CaptureSummary Named(const std::string& name, State state) {
  CaptureSummary summary;
  summary.folder = name;
  summary.name = name;
  summary.state = state;
  return summary;
}

TEST(OverviewPage, WhatFailedComesFirstWhateverTheOrder) {
  std::vector<CaptureSummary> captures = {Named("zinc", State::kFailed), Named("ash", State::kDone),
                                          Named("oak", State::kUnfinished),
                                          Named("elm", State::kDone)};
  const std::string html = OverviewPage(captures, "page.html");
  EXPECT_LT(html.find(">zinc<"), html.find(">oak<"));
  EXPECT_LT(html.find(">oak<"), html.find(">ash<"));
  EXPECT_LT(html.find(">ash<"), html.find(">elm<"));
  EXPECT_THAT(html, HasSubstr("1 failed, 1 unfinished, 2 done"));
  std::reverse(captures.begin(), captures.end());
  EXPECT_EQ(OverviewPage(captures, "page.html"), html);
}

TEST(OverviewPage, NamesAndMessagesAreTextAndLinksAreRelative) {
  CaptureSummary capture = Named("<b>#1 50%</b>", State::kFailed);
  capture.stage = "fit";
  capture.message = "<script>alert(1)</script>";
  capture.page = "/data/sets/<b>#1 50%/glint/report/index.html";
  const std::string html = OverviewPage({capture}, "/data/pages/all.html");
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;#1 50%&lt;/b&gt;"));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)"));
  EXPECT_THAT(html, HasSubstr("href=\"../sets/%3Cb%3E%231%2050%25/glint/report/index.html\""));
  EXPECT_THAT(html, Not(HasSubstr("http")));
}

class CaptureSummaryTest : public testing::Test {
 protected:
  CaptureSummaryTest() {
    test::WriteAll(capture() / "capture.toml",
                   "[sample]\nsize_mm = [100, 100]\n[photos]\nfiles = [\"*.jpg\"]\n"
                   "[board]\nsquares = [12, 12]\nsquare_mm = 15\nmarker_mm = 11\n");
    test::WriteAll(capture() / "a.jpg", "a");
  }
  fs::path capture() const { return folder_ / "wood"; }
  test::TemporaryFolder folder_;
};

TEST_F(CaptureSummaryTest, WhatWasNeverRunIsUnfinished) {
  const CaptureSummary summary = SummariseCapture(capture());
  EXPECT_EQ(summary.name, "wood");
  EXPECT_EQ(summary.state, State::kUnfinished);
  EXPECT_EQ(summary.stage, "calib");
  EXPECT_TRUE(summary.page.empty());
  EXPECT_EQ(SummariseCapture(capture() / "").name, "wood");
}

TEST_F(CaptureSummaryTest, AFailureIsToldByTheProgramsError) {
  test::WriteAll(capture() / FailureFile("calib"),
                 "glint-calib: info: reading\nglint-calib: error: no board is seen\n  a.jpg\n\n");
  const CaptureSummary summary = SummariseCapture(capture());
  EXPECT_EQ(summary.state, State::kFailed);
  EXPECT_EQ(summary.stage, "calib");
  EXPECT_EQ(summary.message, "glint-calib: error: no board is seen\n  a.jpg");
  test::WriteAll(capture() / FailureFile("calib"), "reading\nKilled\n");
  EXPECT_EQ(SummariseCapture(capture()).message, "Killed");
}

TEST_F(CaptureSummaryTest, WhatCannotBeReadHasFailedWithTheReason) {
  const CaptureSummary missing = SummariseCapture(folder_ / "other");
  EXPECT_EQ(missing.state, State::kFailed);
  EXPECT_THAT(missing.message, HasSubstr("other: found no such folder"));
  test::WriteAll(capture() / "glint/calib/manifest.json", "{\"truncated");
  const CaptureSummary damaged = SummariseCapture(capture());
  EXPECT_EQ(damaged.state, State::kFailed);
  EXPECT_THAT(damaged.message, HasSubstr("calib/manifest.json"));
}

}  // namespace
}  // namespace glint
