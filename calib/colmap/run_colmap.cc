#include "calib/colmap/run_colmap.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/files/hash.h"
#include "base/files/json.h"
#include "base/images/image.h"
#include "base/linearize/encoding.h"
#include "base/photos/photo.h"
#include "base/programs/progress.h"
#include "base/programs/subprocess.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// Raised when the steps or their options change, so that kept results are made again.
constexpr int kRunVersion = 2;
// A photograph. Matching takes time with its square: half of COLMAP's own number.
constexpr int kMostFeatures = 4096;
constexpr size_t kEnoughForPrincipalPoint = 6;  // photographs

std::string LowerExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// What COLMAP's image library reads as Glint does.
bool ColmapReads(const fs::path& file) {
  const std::string extension = LowerExtension(file);
  return extension == ".jpg" || extension == ".jpeg" || extension == ".png";
}

// "camera0/0007": flat, so that COLMAP's one camera a folder is ours, and without odd characters.
std::string WorkName(const std::vector<ColmapPhoto>& photos, size_t index) {
  const fs::path& file = photos[index].file;
  return fmt::format("camera{}/{:04}{}", photos[index].camera, index,
                     ColmapReads(file) ? LowerExtension(file) : ".png");
}

void WriteCopy(const fs::path& from, const fs::path& to, const std::string& encoding) {
  const Photo photo = ReadPhoto(from);
  Image image = photo.image.Planes();
  if (ResolveEncoding(encoding, from, photo) == Encoding::kLinear) {
    for (float& value : image.samples) {
      value = std::pow(std::clamp(value, 0.0f, 1.0f), 1 / 2.2f);
    }
  }
  WritePng(to, image);
}

std::string Bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::int64_t Count(const std::string& text, const std::string& word) {
  std::int64_t count = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

// The mapper's model with the most images ("0", "1", …); of equals the first.
std::string LargestModel(const fs::path& work) {
  size_t most = 0;
  std::string largest;
  for (int i = 0; fs::is_directory(work / "sparse" / std::to_string(i)); ++i) {
    const size_t images = ReadColmapModel(work / "sparse" / std::to_string(i)).images.size();
    if (images <= most) continue;
    most = images;
    largest = std::to_string(i);
  }
  if (most == 0) {
    throw ComputationError("colmap produced no model; see " + (work / "log.txt").string() +
                           "; photographs need texture, sharpness and plenty of overlap");
  }
  return largest;
}

class Runner {
 public:
  Runner(const std::vector<ColmapPhoto>& photos, const ColmapRunOptions& options, fs::path work)
      : photos_(photos),
        options_(options),
        work_(std::move(work)),
        program_(FindColmap()),
        progress_("colmap", static_cast<std::int64_t>(4 * photos.size())) {}

  void Run() {
    Prepare();
    ExtractFeatures();
    Match();
    Map();
    Refine();
  }

 private:
  void Prepare() {
    std::error_code error;
    fs::remove_all(work_, error);
    std::string list;
    for (size_t i : ByCamera()) {
      const fs::path image = work_ / "images" / WorkName(photos_, i);
      fs::create_directories(image.parent_path());
      if (ColmapReads(photos_[i].file)) {
        fs::create_symlink(fs::absolute(photos_[i].file), image);
      } else {
        WriteCopy(photos_[i].file, image, options_.encoding);
      }
      list += WorkName(photos_, i) + "\n";
    }
    fs::create_directories(work_ / "sparse");
    WriteFileAtomically(work_ / "images.txt", list);
  }

  // COLMAP gives a camera to every row of images of one folder.
  std::vector<size_t> ByCamera() const {
    std::vector<size_t> order(photos_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return photos_[a].camera < photos_[b].camera; });
    return order;
  }

  void ExtractFeatures() {
    Step({"feature_extractor", "--database_path", Path("database.db"), "--image_path",
          Path("images"), "--image_list_path", Path("images.txt"),
          "--ImageReader.single_camera_per_folder", "1", "--ImageReader.camera_model",
          options_.camera_model, "--SiftExtraction.use_gpu", "0", "--SiftExtraction.num_threads",
          "1", "--SiftExtraction.max_image_size", std::to_string(options_.largest_px),
          "--SiftExtraction.max_num_features", std::to_string(kMostFeatures)},
         "Processed file [");
  }

  void Match() {
    Step({"exhaustive_matcher", "--database_path", Path("database.db"), "--SiftMatching.use_gpu",
          "0", "--SiftMatching.num_threads", "1"},
         "Matching block [");
  }

  void Map() {
    Step({"mapper", "--database_path", Path("database.db"), "--image_path", Path("images"),
          "--output_path", Path("sparse"), "--Mapper.num_threads", "1", "--Mapper.min_model_size",
          "3"},
         "Registering image #");
  }

  // The mapper holds the principal point at the picture's centre; a few photographs tell where it
  // is.
  void Refine() {
    const fs::path largest = work_ / "sparse" / LargestModel(work_);
    fs::create_directories(work_ / "model");
    const bool enough = ReadColmapModel(largest).images.size() >= kEnoughForPrincipalPoint;
    Step({"bundle_adjuster", "--input_path", fs::absolute(largest).string(), "--output_path",
          Path("model"), "--BundleAdjustment.refine_principal_point", enough ? "1" : "0"},
         "iter");
  }

  std::string Path(const char* name) const { return fs::absolute(work_ / name).string(); }

  void Step(std::vector<std::string> arguments, const std::string& marker) {
    const std::string step = arguments[0];
    arguments.insert(arguments.begin(), program_.string());
    arguments.insert(arguments.end(),
                     {"--random_seed", std::to_string(options_.seed % 2147483647)});
    const fs::path log = work_ / "log.txt";
    const auto photos = static_cast<std::int64_t>(photos_.size());
    const auto begin = static_cast<size_t>(fs::exists(log) ? fs::file_size(log) : 0);
    int calls = 0;
    RunToLogOptions run;
    run.environment = {"QT_QPA_PLATFORM=offscreen", "OMP_NUM_THREADS=1"};
    run.while_running = [&] {
      if (calls++ % 10 != 0) return;  // once a second is enough to look at the log
      const std::string text = Bytes(log);
      if (text.size() < begin) return;
      progress_.Set(steps_ * photos + std::min(photos, Count(text.substr(begin), marker)), step);
    };
    try {
      RunToLog(arguments, log, run);
    } catch (const ComputationError& error) {
      throw ComputationError(std::string(error.what()) +
                             "\nphotographs need texture, sharpness and plenty of overlap; use a "
                             "[board] where the sample and its surroundings have no texture");
    }
    progress_.Set(++steps_ * photos, step);
  }

  const std::vector<ColmapPhoto>& photos_;
  const ColmapRunOptions& options_;
  fs::path work_, program_;
  Progress progress_;
  std::int64_t steps_ = 0;
};

// Images and points by ascending id: COLMAP writes them in the order of its hash tables.
void Sort(ColmapModel* model) {
  const auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::sort(model->cameras.begin(), model->cameras.end(), by_id);
  std::sort(model->images.begin(), model->images.end(), by_id);
  std::sort(model->points.begin(), model->points.end(), by_id);
}

Json KeyOf(const std::vector<ColmapPhoto>& photos, const ColmapRunOptions& options) {
  Json key = {{"version", kRunVersion},
              {"camera_model", options.camera_model},
              {"largest_px", options.largest_px},
              {"encoding", options.encoding},
              {"seed", options.seed},
              {"photos", Json::array()}};
  for (const ColmapPhoto& photo : photos) {
    key["photos"].push_back({photo.name, photo.camera, HashFile(photo.file)});
  }
  return key;
}

// Of the model's files, by name.
Json ModelHashes(const fs::path& work) {
  std::map<std::string, std::string> hashes;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(work / "model", error)) {
    if (entry.is_regular_file(error)) {
      hashes[entry.path().filename().string()] = HashFile(entry.path());
    }
  }
  return hashes;
}

// Whether the model in the folder is of these photographs, and as COLMAP wrote it.
bool Kept(const fs::path& work, Json key) {
  if (!fs::exists(work / "key.json") || !fs::is_directory(work / "model")) return false;
  key["model"] = ModelHashes(work);
  return Json::parse(ReadTextFile(work / "key.json"), nullptr, false) == key;
}

}  // namespace

fs::path FindColmap() {
  return ProgramOnPath("colmap", "apt-get install --no-install-recommends colmap");
}

ColmapRun RunColmap(const std::vector<ColmapPhoto>& photos, const ColmapRunOptions& options,
                    const fs::path& work) {
  Json key = KeyOf(photos, options);
  ColmapRun run;
  run.reused = !options.force && Kept(work, key);
  if (run.reused) {
    spdlog::info("colmap's model in {} was made from these photographs; it is used as it is",
                 work.string());
  } else {
    Runner(photos, options, work).Run();
  }
  run.model = ReadColmapModel(work / "model");
  Sort(&run.model);
  for (ColmapImage& image : run.model.images) {
    for (size_t i = 0; i < photos.size(); ++i) {
      if (image.name == WorkName(photos, i)) {
        image.name = photos[i].name;
        break;
      }
    }
  }
  for (const ColmapPhoto& photo : photos) run.upright.push_back(!ColmapReads(photo.file));
  if (!run.reused) {
    key["model"] = ModelHashes(work);
    WriteFileAtomically(work / "key.json", key.dump(1) + "\n");
  }
  return run;
}

}  // namespace glint
