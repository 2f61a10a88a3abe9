// The corpora of all fuzz targets, without libFuzzer: every file read, every file cut off anywhere,
// every file with bytes changed, inserted and left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/fuzz/targets.h"
#include "tests/support/process.h"

namespace glint::fuzz {
namespace {

namespace fs = std::filesystem;

class CorporaTest : public testing::TestWithParam<std::string> {
 protected:
  std::vector<fs::path> Files() const {
    std::vector<fs::path> files;
    for (const auto& entry :
         fs::directory_iterator(fs::path(GLINT_SOURCE_DIR) / "tests/fuzz/corpora" / GetParam())) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  static int Replays() { return FindFuzzTarget(GetParam()).replays; }
  bool Reads(std::string_view bytes) const {
    return Accepts(FindFuzzTarget(GetParam()), folder_.path(), bytes);
  }

 private:
  const test::TemporaryFolder folder_;
};

TEST_P(CorporaTest, SeedsAreReadAndNothingWorseThanAnErrorHappens) {
  int read = 0;
  for (const fs::path& file : Files()) {
    const bool accepted = Reads(test::ReadAll(file));
    // What once was a finding is kept beside the seeds and need not be read.
    const bool is_seed = file.filename().string().starts_with("seed");
    EXPECT_TRUE(accepted || !is_seed) << file;
    read += accepted;
  }
  EXPECT_GT(read, 0);
}

TEST_P(CorporaTest, CutOffFilesAreNoWorseThanAnError) {
  for (const fs::path& file : Files()) {
    const std::string bytes = test::ReadAll(file);
    for (int i = 0; i < Replays(); ++i)
      Reads(std::string_view(bytes).substr(0, bytes.size() * i / Replays()));
  }
}

TEST_P(CorporaTest, ChangedFilesAreNoWorseThanAnError) {
  std::mt19937 random(1);
  for (const fs::path& file : Files()) {
    const std::string original = test::ReadAll(file);
    for (int i = 0; i < Replays(); ++i) {
      std::string bytes = original;
      for (int changes = 1 + static_cast<int>(random() % 4); changes > 0 && !bytes.empty();
           --changes) {
        const size_t place = random() % bytes.size();
        switch (random() % 3) {
          case 0:
            bytes[place] = static_cast<char>(random());
            break;
          case 1:
            bytes.erase(place, 1 + random() % 8);
            break;
          default:
            bytes.insert(place, bytes.substr(random() % bytes.size(), 1 + random() % 16));
        }
      }
      Reads(bytes);
    }
  }
}

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const FuzzTarget& target : FuzzTargets()) names.push_back(target.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(AllFormats, CorporaTest, testing::ValuesIn(Names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glint::fuzz
