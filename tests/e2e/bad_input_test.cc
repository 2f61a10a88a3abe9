// Bad input: exit code 2 (1 where it is the computation that fails), one message that names the
// file, the field, what was found and the remedy; nothing written outside glint/, earlier results
// kept.
#include <gmock/gmock.h>

#include "base/files/json.h"
#include "base/images/image.h"
#include "base/photos/photo.h"
#include "tests/e2e/capture_fixture.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BadInputTest : public CaptureTest {
 protected:
  // Runs `words` (glint run CAPTURE when empty) on the spoilt capture and checks all that is
  // promised.
  // Results of stage `but`, which comes before the one that refuses, may be new.
  void ExpectRefusal(const std::vector<std::string>& message_parts, int code = 2,
                     std::vector<std::string> words = {}, const std::string& but = "") const {
    const Tree sources = Sources(capture());
    const Tree results = ResultsBut(but);
    if (words.empty()) words = {"run", capture().string()};
    const Outcome outcome = Glint(words);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    for (const std::string& part : message_parts) EXPECT_THAT(outcome.err, HasSubstr(part));
    // One message, from the program that noticed.
    size_t errors = 0;
    for (size_t at = outcome.err.find("error: "); at != std::string::npos;
         at = outcome.err.find("error: ", at + 1)) {
      ++errors;
    }
    EXPECT_EQ(errors, 1u) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("; ")) << "no remedy";
    EXPECT_EQ(Differences(sources, Sources(capture())), "") << "written outside glint/";
    EXPECT_EQ(Differences(results, ResultsBut(but)), "") << "earlier results touched";
  }

  Tree ResultsBut(const std::string& stage) const {
    Tree tree = Results(capture());
    std::erase_if(tree, [&](const auto& entry) {
      return !stage.empty() && entry.first.rfind(stage + "/", 0) == 0;
    });
    return tree;
  }

  std::string Toml() const { return (capture() / "capture.toml").string(); }
  fs::path Manifest(const std::string& stage) const {
    return capture() / "glint" / stage / "manifest.json";
  }
  void EditManifest(const std::string& stage, const std::function<void(Json*)>& edit) const {
    Json json = Json::parse(ReadAll(Manifest(stage)));
    edit(&json);
    json.erase("seal");  // as another program would have written it
    WriteAll(Manifest(stage), json.dump(2) + "\n");
  }
  // Puts another picture in a photograph's place, under the extension of its own format.
  void Replace(const fs::path& photo, const Image& image, const std::string& extension) const {
    if (extension == ".exr") {
      WriteExr(fs::path(photo).replace_extension(extension), image);
    } else {
      WritePng(fs::path(photo).replace_extension(extension), image);
    }
    fs::remove(photo);
    if (ReadAll(Toml()).find("photos/*.jpg") != std::string::npos)
      EditToml("photos/*.jpg", "photos/*");
  }
  void ReplaceByColor(const fs::path& photo, float value, int width, int height) const {
    Image image(width, height, {"R", "G", "B"});
    std::fill(image.samples.begin(), image.samples.end(), value);
    Replace(photo, image, ".png");
  }
};

// --- capture.toml ---

TEST_F(BadInputTest, MissingCaptureToml) {
  fs::remove(capture() / "capture.toml");
  ExpectRefusal({Toml(), "found no such file", "glint init"});
}

TEST_F(BadInputTest, CaptureTomlThatIsAFolder) {
  fs::remove(capture() / "capture.toml");
  fs::create_directory(capture() / "capture.toml");
  ExpectRefusal({Toml(), "found something that is not a file"});
}

TEST_F(BadInputTest, CaptureTomlThatIsNoToml) {
  WriteAll(capture() / "capture.toml", "[sample\nsize_mm = 3\n");
  ExpectRefusal({Toml(), "line 1", "syntax error", "write TOML"});
}

TEST_F(BadInputTest, UnknownKey) {
  EditToml("[sample]", "[sample]\nsise_mm = [1, 1]");
  ExpectRefusal({Toml(), "sample.sise_mm (line ", "found an unknown key", "size_mm"});
}

TEST_F(BadInputTest, UnknownTable) {
  EditToml("[refine]", "[refines]");
  ExpectRefusal({Toml(), "refines", "found an unknown key", "use one of"});
}

TEST_F(BadInputTest, UnknownOptionOfAStage) {
  EditToml("[refine]\niterations", "[refine]\niterashuns");
  ExpectRefusal({Toml(), "refine.iterashuns (line ", "found an unknown key", "use one of"});
}

TEST_F(BadInputTest, WrongType) {
  EditToml("square_mm = ", "square_mm = \"fifteen\" # ");
  ExpectRefusal({Toml(), "board.square_mm (line ", "found the text 'fifteen'", "millimetres"});
}

TEST_F(BadInputTest, WrongUnit) {
  EditToml("size_mm = ", "size_mm = [\"10cm\", \"10cm\"] # ");
  ExpectRefusal({Toml(), "sample.size_mm", "found the text '10cm'", "millimetres"});
}

TEST_F(BadInputTest, OptionOutOfRange) {
  EditToml("[refine]\niterations = 8", "[refine]\niterations = -8");
  ExpectRefusal({Toml(), "refine.iterations (line ", "-8", "use a value from"});
}

// --- photographs ---

TEST_F(BadInputTest, NoPhotographs) {
  for (const fs::path& photo : Photos()) fs::remove(photo);
  ExpectRefusal({Toml(), "photos.files", "found no photograph that matches"});
}

TEST_F(BadInputTest, APhotographThatIsText) {
  WriteAll(Photos()[1], "this is no photograph\n");
  ExpectRefusal({Photos()[1].string(), "found no image that can be read", "give a JPEG"});
}

TEST_F(BadInputTest, AnEmptyPhotograph) {
  WriteAll(Photos()[1], "");
  ExpectRefusal({Photos()[1].string(), "found an empty file", "copy the photograph again"});
}

TEST_F(BadInputTest, ATruncatedPhotograph) {
  // All but the last bytes: enough for the board to be found in it.
  const std::string bytes = ReadAll(Photos()[1]);
  WriteAll(Photos()[1], bytes.substr(0, bytes.size() - 1000));
  ExpectRefusal({Photos()[1].string(), "found a truncated JPEG file", "copy the photograph again"});
}

TEST_F(BadInputTest, APhotographOfOnePixel) {
  ReplaceByColor(Photos()[1], 0.5f, 1, 1);
  ExpectRefusal({Photos()[1].string(), "size", "found 1x1 pixels"});
}

TEST_F(BadInputTest, APhotographWithNan) {
  Image image = ReadPhoto(Photos()[1]).image.Planes();
  image.samples[1000] = std::numeric_limits<float>::quiet_NaN();
  Replace(Photos()[1], image, ".exr");
  ExpectRefusal({Photos()[1].string(), "pixel (", "found a value that is not a number"});
}

TEST_F(BadInputTest, APhotographOfAnotherSizeIsLeftOutWithAWord) {
  ReplaceByColor(Photos()[1], 0.5f, 800, 600);
  const Outcome outcome = RunCapture({"--until", "calib"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::HasSubstr(Photos()[1].filename().string() + " is left out"));
  EXPECT_THAT(outcome.err, testing::HasSubstr("800x600 pixels, while"));
}

// --- board ---

TEST_F(BadInputTest, BoardInNoPhotograph) {
  for (const fs::path& photo : Photos()) ReplaceByColor(photo, 0.5f, 1152, 864);
  ExpectRefusal({Toml(), "found the board in none of the 4 photographs", "check [board]"});
}

TEST_F(BadInputTest, BoardInOnePhotographOnly) {
  // All as PNG, so that none has the EXIF of another camera.
  const Image first = ReadPhoto(Photos()[0]).image.Planes();
  Replace(Photos()[0], first, ".png");
  for (size_t i = 1; i < Photos().size(); ++i) {
    ReplaceByColor(Photos()[i], 0.5f, first.width, first.height);
  }
  ExpectRefusal({Toml(), "found the board in only one of the 4 photographs", "at least two"});
}

TEST_F(BadInputTest, EveryPixelSaturated) {
  for (const fs::path& photo : Photos()) ReplaceByColor(photo, 1.0f, 1152, 864);
  ExpectRefusal({Toml(), "found the board in none of the 4 photographs", "check [board]"});
}

TEST_F(BadInputTest, EveryPixelBlack) {
  for (const fs::path& photo : Photos()) ReplaceByColor(photo, 0.0f, 1152, 864);
  ExpectRefusal({Toml(), "found the board in none of the 4 photographs", "check [board]"});
}

TEST_F(BadInputTest, BoardThatCannotBe) {
  EditToml("marker_mm = ", "marker_mm = 90 # ");
  ExpectRefusal({Toml(), "board", "marker_mm", "90"});
}

TEST_F(BadInputTest, BoardOfAnotherDictionary) {
  EditToml("dictionary = \"DICT_5X5_1000\"", "dictionary = \"DICT_7X7_1000\"");
  ExpectRefusal({Toml(), "found the board in none of the 4 photographs", "check [board]",
                 "shows 94 markers of DICT_5X5"});
}

TEST_F(BadInputTest, BoardOfFewerSquaresThanAreSeen) {
  EditToml("squares = [18, 14]", "squares = [14, 10]");
  EditToml("window = ", "# ");
  ExpectRefusal({Toml(), "board", "found a board that does not fit the description", "squares"});
}

TEST_F(BadInputTest, SampleWindowOutsideThePhotographs) {
  EditToml("[sample]", "[sample]\ncentre_mm = [2000, 0]");
  ExpectRefusal({Photos()[0].string(), "sample", "check [sample] size_mm and centre_mm"}, 2, {},
                "calib");
}

// --- results of earlier stages, read by a stage on its own (glint run makes them anew) ---

TEST_F(BadInputTest, ManifestOfAnotherVersion) {
  EditManifest("rectify", [](Json* json) { (*json)["glint_manifest"] = 99; });
  ExpectRefusal({Manifest("rectify").string(), "glint_manifest", "found 99", "run the stage again"},
                2, {"fit", capture().string()});
}

TEST_F(BadInputTest, ManifestWithAMissingField) {
  EditManifest("rectify", [](Json* json) { (*json)["data"].erase("views"); });
  ExpectRefusal({Manifest("rectify").string(), "data.views", "found no such field"}, 2,
                {"fit", capture().string()});
}

TEST_F(BadInputTest, ManifestThatIsNoJson) {
  WriteAll(Manifest("fit"), "{");
  ExpectRefusal({Manifest("fit").string(), "found text that is not JSON"}, 2,
                {"refine", capture().string()});
}

TEST_F(BadInputTest, AnImageThatDoesNotHashAsTheManifestSays) {
  const Image image = ReadExr(capture() / "glint/rectify/view_000.exr");
  Image darker = image;
  for (float& sample : darker.samples) sample *= 0.5f;
  WriteExr(capture() / "glint/rectify/view_000.exr", darker);
  for (const char* stage : {"fit", "refine"}) {
    ExpectRefusal({Manifest("rectify").string(), "outputs[0].hash", "view_000.exr", "run stage"}, 2,
                  {stage, capture().string(), "--force"});
  }
}

TEST_F(BadInputTest, MapsThatDoNotHashAsTheManifestSays) {
  WriteAll(capture() / "glint/refine/svbrdf.exr", "damaged");
  for (const char* stage : {"export", "report"}) {
    ExpectRefusal({Manifest("refine").string(), "svbrdf.exr", "run stage 'refine' again"}, 2,
                  {stage, capture().string(), "--force"});
  }
}

TEST_F(BadInputTest, GlintRunMendsDamagedResults) {
  EditManifest("rectify", [](Json* json) { (*json)["glint_manifest"] = 99; });
  WriteAll(capture() / "glint/refine/svbrdf.exr", "damaged");
  const Outcome outcome = RunCapture();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Differences(Results(finished()), Results(capture())), "");
}

TEST_F(BadInputTest, ATruncatedWeightsFile) {
  const fs::path weights = capture() / "weights.safetensors";
  // A safetensors header that says it is longer than the file.
  WriteAll(weights, std::string("\x00\x10\x00\x00\x00\x00\x00\x00{\"w\":", 13));
  ExpectRefusal({weights.string()}, 2,
                {"fit", capture().string(), "--method", "latent", "--weights", weights.string()});
}

TEST_F(BadInputTest, ATruncatedEstimatorFile) {
  const fs::path weights = capture() / "estimator.safetensors";
  WriteAll(weights, std::string("\x00\x10\x00\x00\x00\x00\x00\x00{\"w\":", 13));
  ExpectRefusal(
      {weights.string()}, 2,
      {"fit", capture().string(), "--initial-maps", "estimator", "--estimator", weights.string()});
}

TEST_F(BadInputTest, WeightsOfTheOtherNetwork) {
  const fs::path estimator = fs::path(GLINT_SOURCE_DIR) / "fitting/models/estimator.safetensors";
  ExpectRefusal({estimator.string(), "architecture", "glint-autoencoder"}, 2,
                {"fit", capture().string(), "--weights", estimator.string()});
}

// --- usage ---

TEST_F(BadInputTest, UnknownStage) {
  ExpectRefusal({"--until", "found the unknown stage 'bake'", "use one of: calib"}, 2,
                {"run", capture().string(), "--until", "bake"});
}

TEST_F(BadInputTest, UnknownOption) {
  ExpectRefusal({"--untill", "glint-run --help"}, 2, {"run", capture().string(), "--untill=fit"});
}

TEST_F(BadInputTest, UnknownPhotographToKeepBack) {
  ExpectRefusal({"nowhere.jpg"}, 2, {"run", capture().string(), "--exclude", "nowhere.jpg"});
}

// --- photographs that are all taken from straight above ---

TEST_F(BadInputTest, AllPhotographsFrontoParallel) {
  const fs::path flat = folder() / "flat";
  const Outcome synth =
      RunProgram({Program("glint-synth"), "capture", flat.string(), "--megapixels", "1", "--photos",
                  "4", "--texels", "64", "--resolution", "64", "--seed", "5", "--tilt-deg", "0"});
  ASSERT_EQ(synth.code, 0) << synth.err;
  const Outcome outcome = Glint({"run", flat.string(), "--until", "calib"});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(flat.string() + "/capture.toml: photos: found 4 photographs"));
  EXPECT_THAT(outcome.err, HasSubstr("tilt the phone by"));
}

}  // namespace
}  // namespace glint::test
