#include "tests/e2e/capture_fixture.h"

#include <algorithm>
#include <chrono>
#include <memory>

namespace glint::test {
namespace {

namespace fs = std::filesystem;

// Few texels and few iterations: the stages do all they do, quickly.
constexpr char kQuickOptions[] = R"(
[fit]
iterations = 12
[refine]
iterations = 8
)";

struct Finished {
  TemporaryFolder folder;
  fs::path capture;
  double seconds = 0;
};

std::unique_ptr<Finished> finished_capture;

Tree ReadTree(const fs::path& folder) {
  Tree tree;
  for (auto entry = fs::recursive_directory_iterator(folder);
       entry != fs::recursive_directory_iterator(); ++entry) {
    const std::string path = entry->path().lexically_relative(folder).generic_string();
    if (entry->is_regular_file()) tree[path] = ReadAll(entry->path());
    if (entry->is_symlink()) tree[path] = fs::read_symlink(entry->path());
  }
  return tree;
}

void MakeFinished() {
  finished_capture = std::make_unique<Finished>();
  finished_capture->capture = finished_capture->folder.path() / "wood";
  const std::string capture = finished_capture->capture;
  const Outcome synth =
      RunProgram({Program("glint-synth"), "capture", capture, "--megapixels", "1", "--photos", "4",
                  "--texels", "256", "--resolution", "64", "--seed", "5"});
  ASSERT_EQ(synth.code, 0) << synth.err;
  std::string options = kQuickOptions;
  // A checkout whose weights are not trained yet still tests all the rest.
  if (!HasWeights())
    options.replace(options.find("[fit]"), 5,
                    "[fit]\nmethod = \"classic\"\ninitial-maps = \"rules\"");
  std::ofstream(finished_capture->capture / "capture.toml", std::ios::app) << options;
  const auto start = std::chrono::steady_clock::now();
  const Outcome run = RunProgram({Program("glint"), "run", capture});
  ASSERT_EQ(run.code, 0) << run.err;
  finished_capture->seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

bool HasWeights() {
  const fs::path models = fs::path(GLINT_SOURCE_DIR) / "fitting/models";
  return fs::exists(models / "autoencoder.safetensors") &&
         fs::exists(models / "estimator.safetensors");
}

Tree Sources(const fs::path& capture) {
  Tree tree = ReadTree(capture);
  std::erase_if(tree, [](const auto& entry) { return entry.first.rfind("glint/", 0) == 0; });
  return tree;
}

Tree Results(const fs::path& capture) {
  Tree tree = ReadTree(capture / "glint");
  std::erase_if(tree, [](const auto& entry) {
    const fs::path path = entry.first;
    return !path.has_parent_path() || path.filename() == "run.json" || entry.first[0] == '.';
  });
  return tree;
}

std::string Differences(const Tree& a, const Tree& b) {
  std::string text;
  for (const auto& [path, content] : a) {
    const auto found = b.find(path);
    if (found == b.end()) {
      text += "only in the first: " + path + "\n";
    } else if (found->second != content) {
      text += "differs: " + path + "\n";
    }
  }
  for (const auto& [path, content] : b) {
    if (a.count(path) == 0) text += "only in the second: " + path + "\n";
  }
  return text;
}

void CopyCapture(const fs::path& from, const fs::path& to) {
  const Outcome copied = RunProgram({"cp", "-a", from.string(), to.string()});
  ASSERT_EQ(copied.code, 0) << copied.err;
}

std::string Program(const std::string& name) { return (fs::path(GLINT_BIN_DIR) / name).string(); }

void CaptureTest::SetUpTestSuite() {
  if (finished_capture == nullptr) MakeFinished();
}

const fs::path& CaptureTest::finished() { return finished_capture->capture; }
double CaptureTest::run_seconds() { return finished_capture->seconds; }

CaptureTest::CaptureTest() : capture_(folder_.path() / "wood") {
  CopyCapture(finished(), capture_);
}

Outcome CaptureTest::Glint(std::vector<std::string> words) const {
  words.insert(words.begin(), Program("glint"));
  return RunProgram(words);
}

Outcome CaptureTest::RunCapture(std::vector<std::string> more) const {
  more.insert(more.begin(), {"run", capture_.string()});
  return Glint(more);
}

void CaptureTest::EditToml(const std::string& from, const std::string& to) const {
  const fs::path file = capture_ / "capture.toml";
  std::string text = ReadAll(file);
  const size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << "capture.toml has no " << from << ":\n" << text;
  text.replace(at, from.size(), to);
  WriteAll(file, text);
}

std::vector<fs::path> CaptureTest::Photos() const {
  std::vector<fs::path> photos;
  for (const auto& entry : fs::directory_iterator(capture_ / "photos")) {
    photos.push_back(entry.path());
  }
  std::sort(photos.begin(), photos.end());
  return photos;
}

// The fixture outlives all suites of the program and is removed at its end.
class RemoveFinished : public testing::Environment {
 public:
  void TearDown() override { finished_capture.reset(); }
};
[[maybe_unused]] const testing::Environment* const kRemoveFinished =
    testing::AddGlobalTestEnvironment(new RemoveFinished);

}  // namespace glint::test
