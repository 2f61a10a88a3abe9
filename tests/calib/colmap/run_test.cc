#include "calib/colmap/run_colmap.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// A program in colmap's place that finds the same small model every time.
class RunColmapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path found = folder_.path() / "found";
    test::WriteAll(found / "cameras.txt", "1 RADIAL 640 480 500 320 240 0 0\n");
    test::WriteAll(found / "images.txt",
                   "1 1 0 0 0 0 0 240 1 camera0/0000.png\n100 100 1\n"
                   "2 1 0 0 0 9 0 240 1 camera0/0001.png\n119 100 1\n");
    test::WriteAll(found / "points3D.txt", "1 -100 -70 0 128 128 128 0.5 1 0 2 0\n");
    const fs::path program = folder_.path() / "bin/colmap";
    test::WriteAll(program,
                   "#!/bin/sh\nwhile [ $# -gt 0 ]; do\n"
                   "  [ \"$1\" = --output_path ] && to=$2\n"
                   "  [ \"$1\" = mapper ] && below=/0\n  shift\ndone\n"
                   "[ -z \"$to\" ] && exit 0\n"
                   "mkdir -p \"$to$below\" && cp " +
                       found.string() + "/* \"$to$below\"\n");
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (program.parent_path().string() + ":/usr/bin:/bin").c_str(), 1);
    for (const char* name : {"a.png", "b.png"}) test::WriteAll(folder_.path() / name, name);
  }

  ColmapRun Run() {
    return RunColmap(
        {{folder_.path() / "a.png", "photos/a.png"}, {folder_.path() / "b.png", "photos/b.png"}},
        {}, work());
  }
  fs::path work() const { return folder_.path() / "work"; }

  test::TemporaryFolder folder_;
};

TEST_F(RunColmapTest, TheModelOfTheSamePhotographsIsTakenAgain) {
  const ColmapRun first = Run();
  EXPECT_FALSE(first.reused);
  ASSERT_EQ(first.model.images.size(), 2u);
  EXPECT_EQ(first.model.images[1].name, "photos/b.png");
  EXPECT_TRUE(Run().reused);
  test::WriteAll(folder_.path() / "b.png", "another photograph");
  EXPECT_FALSE(Run().reused);
}

TEST_F(RunColmapTest, AKeptModelThatIsNotAsColmapWroteItIsFoundAgain) {
  Run();
  for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"}) {
    const std::string whole = test::ReadAll(work() / "model" / name);
    std::string flipped = whole;
    flipped[flipped.size() / 2] ^= 1;
    test::WriteAll(work() / "model" / name, flipped);
    EXPECT_FALSE(Run().reused) << name;
    EXPECT_EQ(test::ReadAll(work() / "model" / name), whole);
  }
  fs::remove(work() / "model/points3D.txt");
  EXPECT_FALSE(Run().reused);
  EXPECT_TRUE(Run().reused);
}

}  // namespace
}  // namespace glint
