#include "pipeline/studio/workspace.h"

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>

#include "base/errors/errors.h"
#include "pipeline/files/hash.h"
#include "pipeline/files/json_file.h"
#include "pipeline/photos/photo_name.h"
#include "pipeline/studio/option_form.h"
#include "pipeline/studio/program_message.h"
#include "pipeline/studio/received_photo.h"
#include "pipeline/studio/results.h"
#include "pipeline/studio/toml_edit.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<FileLock> LockFolder(const fs::path& root) {
  std::error_code error;
  if (!fs::is_directory(root, error)) {
    throw UserError(root, "", "no such folder", "make it, or name another");
  }
  fs::create_directories(root / kStudioFolder, error);
  if (error || ::access((root / kStudioFolder).c_str(), W_OK) != 0) return nullptr;  // read-only
  return std::make_unique<FileLock>(root / kStudioFolder / "lock",
                                    "another Glint Studio of this folder");
}

void RemoveHalfMade(const fs::path& root) {
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::directory_iterator(root / kStudioFolder, error)) {
    if (entry.path().filename().string().starts_with("new-")) leftovers.push_back(entry.path());
  }
  for (const fs::path& folder : leftovers) fs::remove_all(folder, error);
}

double ChangedAt_s(const fs::path& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) return 0;
  constexpr double kNano = 1e-9;
  return static_cast<double>(facts.st_mtim.tv_sec) +
         kNano * static_cast<double>(facts.st_mtim.tv_nsec);
}

fs::path AdviceFile(const fs::path& capture) { return StudioFolderOf(capture) / "advice.json"; }
fs::path UndecidedFile(const fs::path& capture) {
  return StudioFolderOf(capture) / "undecided.json";
}

Json JsonIfAny(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return nullptr;
  try {
    return ReadJsonFile(file, "");
  } catch (const Error&) {
    return nullptr;
  }
}

// What only makes Studio quicker may be lost.
void KeepIfPossible(const fs::path& file, const Json& json) {
  if (JsonIfAny(file) == json) return;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  try {
    WriteFileAtomically(file, json.dump() + "\n");
  } catch (const Error&) {
  }
}

std::set<std::string> Undecided(const fs::path& capture) {
  const Json list = JsonIfAny(UndecidedFile(capture));
  std::set<std::string> names;
  for (const Json& one : list.is_array() ? list : Json::array()) {
    if (one.is_string()) names.insert(one.get<std::string>());
  }
  return names;
}

// What a judgement depends on beside the photographs.
std::string KeyOfJudgement(const std::optional<Capture>& capture, const CheckTask& task) {
  if (!capture) return "draft\n";
  return task.Key() + std::to_string(capture->resolution_px[0]) + " " +
         std::to_string(static_cast<int>(capture->kind)) + "\n";
}

std::string KindOf(const Capture& capture) {
  if (capture.fixed_camera()) return "fixed camera";
  if (capture.has_board) return "board";
  if (capture.imported()) return "rectified";
  return "single";
}

// As `glint init --single` describes it.
bool IsOfOnePhotograph(const Capture& capture) {
  const Json saved = SavedOptions(capture);
  return saved.contains("calib") && saved["calib"].value("poses", "") == "above";
}

Json DirectionJson(const std::optional<Direction>& direction) {
  if (!direction) return nullptr;
  return {{"tilt_deg", direction->tilt_deg}, {"azimuth_deg", direction->azimuth_deg}};
}

Json AdviceJson(const StudioAdvice& advice) {
  return {{"verdict", advice.verdict},
          {"sentence", advice.sentence},
          {"target", DirectionJson(advice.target)},
          {"enough", advice.enough},
          {"list", advice.list}};
}

// 1: edges as sharp as a good phone's (1.5 px of 4000, triage.h), falling with their width.
Json SharpnessOf(const PhotoMeasures& measures) {
  constexpr double kGoodShare = 1.5 / 4000;
  const double width_px = std::max(measures.edge_px, measures.blur_px);
  const int side_px = std::max(measures.file.image.width, measures.file.image.height);
  if (!(width_px > 0) || side_px == 0) return nullptr;
  return std::min(1.0, kGoodShare * side_px / width_px);
}

Json PhotoJson(const StudioPhoto& photo, const std::string& thumbnails) {
  return {{"id", photo.id},
          {"name", photo.name},
          {"thumbnail", nullptr},
          {"state", "waiting"},
          {"left_out", photo.left_out},
          {"reason", nullptr},
          {"remedy", nullptr},
          {"board_found", false},
          {"sharpness", nullptr},
          {"clipped_share", nullptr},
          {"tilt_deg", nullptr},
          {"azimuth_deg", nullptr},
          {"same_as", nullptr},
          {"added_s", photo.added_s},
          {"url_of_thumbnail", thumbnails + photo.id}};
}

void AddCheck(const CheckedPhoto& checked, Json* json) {
  const PhotoCheck& check = *checked.check;
  if (!checked.thumbnail.empty()) {
    (*json)["thumbnail"] =
        (*json)["url_of_thumbnail"].get<std::string>() + "?v=" + checked.content.substr(0, 8);
  }
  (*json)["board_found"] = check.board_found;
  if (!check.unreadable.empty()) return;
  (*json)["sharpness"] = SharpnessOf(check.measures);
  (*json)["clipped_share"] = check.board_found ? check.clipped_share : check.measures.clipped;
  if (!check.pose) return;
  const Direction direction = DirectionOf(check.pose->camera_in_sample_mm);
  (*json)["tilt_deg"] = direction.tilt_deg;
  (*json)["azimuth_deg"] = direction.azimuth_deg;
}

void AddVerdict(const PhotoVerdict& verdict, const std::map<std::string, std::string>& ids,
                Json* json) {
  (*json)["state"] = StateName(verdict.state);
  if (!verdict.reason.empty()) (*json)["reason"] = verdict.reason;
  if (!verdict.remedy.empty()) (*json)["remedy"] = verdict.remedy;
  const auto same = ids.find(verdict.same_as);
  if (same != ids.end()) (*json)["same_as"] = same->second;
}

}  // namespace

struct Workspace::State {
  std::optional<Capture> capture;  // none: a draft, or broken
  std::optional<NewCapture> draft;
  ProgramMessage problem;  // of a capture.toml that cannot be read
  fs::path folder;
  CheckTask task;
};

Workspace::Workspace(const fs::path& root, int check_threads)
    : root_(fs::canonical(root)),
      lock_(LockFolder(root_)),
      boards_(root_ / kStudioFolder / "boards") {
  RemoveHalfMade(root_);
  for (const LibraryEntry& entry : FindCaptures(root_)) {
    ReceivedPhoto::RemoveLeftovers(entry.folder / "photos");
  }
  runs_ = std::make_unique<RunManager>(
      [this](const std::string& capture) { events_.Publish("run", capture); });
  checks_ = std::make_unique<CheckQueue>(check_threads, [this](const std::string& capture) {
    LeaveOutBad(capture);
    events_.Publish("photograph", capture);
  });
}

Workspace::~Workspace() {
  events_.Close();
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    ending_ = true;
    end_.notify_all();
  }
  if (preparing_.joinable()) preparing_.join();
  checks_->Stop();  // before it is gone: what it calls back asks it
  runs_.reset();
}

std::vector<LibraryEntry> Workspace::Captures(bool again) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kFresh = std::chrono::seconds(1);  // others make captures too
  const std::lock_guard<std::mutex> guard(mutex_);
  if (again || Clock::now() - listed_at_ > kFresh) {
    listed_ = FindCaptures(root_);
    listed_at_ = Clock::now();
  }
  return listed_;
}

LibraryEntry Workspace::Find(const std::string& capture) {
  for (const bool again : {false, true}) {
    for (const LibraryEntry& entry : Captures(again)) {
      std::error_code error;
      if (entry.id == capture && fs::is_directory(entry.folder, error)) return entry;
    }
  }
  throw HttpError{404, "there is no such capture (any more)", "reload the page"};
}

std::shared_ptr<std::mutex> Workspace::MutexOf(const std::string& capture) {
  const std::lock_guard<std::mutex> guard(mutex_);
  auto& mutex = captures_[capture];
  if (!mutex) mutex = std::make_shared<std::mutex>();
  return mutex;
}

Workspace::State Workspace::Read(const LibraryEntry& entry) const {
  State state;
  state.folder = entry.folder;
  try {
    if (IsDraft(entry.folder)) {
      state.draft = ReadDraft(entry.folder);
    } else {
      state.capture = ReadCapture(entry.folder, Photographs::kMayBeMissing);
      state.task = CheckTaskOf(*state.capture);
    }
  } catch (const Error& error) {
    std::string text = error.what();
    const std::string folder = entry.folder.string() + "/";
    if (text.starts_with(folder)) text = text.substr(folder.size());
    state.problem = SplitMessage(text);
  }
  return state;
}

std::vector<StudioPhoto> Workspace::PhotosOf(const State& state) const {
  std::vector<std::pair<std::string, bool>> places;
  if (state.capture) {
    for (const std::string& place : state.capture->photos) places.emplace_back(place, false);
    for (const std::string& place : state.capture->left_out_photos)
      places.emplace_back(place, true);
  } else if (state.draft) {
    std::error_code error;
    for (const auto& file : fs::directory_iterator(state.folder / "photos", error)) {
      const std::string name = file.path().filename();
      if (name[0] != '.' && file.is_regular_file(error))
        places.emplace_back("photos/" + name, false);
    }
  }
  std::vector<StudioPhoto> photos;
  for (const auto& [place, left_out] : places) {
    const fs::path file = state.folder / place;
    photos.push_back({IdOf(place), fs::path(place).filename(), place, file, left_out,
                      ChangedAt_s(SplitPhotoName(file).file)});
  }
  std::stable_sort(photos.begin(), photos.end(), [](const StudioPhoto& a, const StudioPhoto& b) {
    return a.added_s != b.added_s ? a.added_s < b.added_s : a.name < b.name;
  });
  return photos;
}

Json Workspace::StudioJson() const {
  struct statvfs facts {};
  std::uint64_t free_bytes = 0;
  if (::statvfs(root_.c_str(), &facts) == 0) {
    free_bytes = static_cast<std::uint64_t>(facts.f_bavail) * facts.f_frsize;
  }
  return {{"folder", root_.string()}, {"free_bytes", free_bytes}, {"read_only", lock_ == nullptr}};
}

std::string Workspace::StatusOf(const LibraryEntry& entry, const State& state,
                                const std::vector<StudioPhoto>& photos) {
  if (runs_->IsRunning(entry.id) || RunsElsewhere(entry.folder)) return "running";
  if (!state.problem.message.empty()) return "failed";
  const bool imported = state.capture && state.capture->imported();
  if (photos.empty() && !imported) return "empty";
  const double report_s = ChangedAt_s(entry.folder / "glint" / "report" / "manifest.json");
  const double record_s = ChangedAt_s(StudioFolderOf(entry.folder) / "run.json");
  const auto last = runs_->Look(entry.id, entry.folder);
  if (last && last->state == "failed" && record_s > report_s) return "failed";
  if (report_s == 0) return "ready";
  const double result_s = last && last->state == "done" ? std::max(report_s, record_s) : report_s;
  double newest_s = std::max(ChangedAt_s(entry.folder / "capture.toml"),
                             ChangedAt_s(entry.folder / "board.json"));
  for (const StudioPhoto& photo : photos) newest_s = std::max(newest_s, photo.added_s);
  return newest_s > result_s ? "out of date" : "done";
}

Json Workspace::RowJson(const LibraryEntry& entry, const State& state,
                        const std::vector<StudioPhoto>& photos) {
  Json row = {{"id", entry.id},
              {"name", entry.name},
              {"kind", state.draft     ? state.draft->kind
                       : state.capture ? KindOf(*state.capture)
                                       : "board"},
              {"size_mm", nullptr},
              {"photographs", photos.size()},
              {"verdict", "none"},
              {"status", StatusOf(entry, state, photos)},
              {"thumbnail", nullptr}};
  if (state.capture) row["size_mm"] = state.capture->sample_size_mm;
  if (state.draft && state.draft->size_mm) row["size_mm"] = *state.draft->size_mm;
  double changed_s = std::max(ChangedAt_s(entry.folder / "capture.toml"),
                              ChangedAt_s(entry.folder / "glint" / "report" / "manifest.json"));
  for (const StudioPhoto& photo : photos) changed_s = std::max(changed_s, photo.added_s);
  row["changed_s"] = changed_s > 0 ? changed_s : ChangedAt_s(entry.folder);
  const Json advice = JsonIfAny(AdviceFile(entry.folder));
  if (advice.is_object()) row["verdict"] = advice.value("verdict", "none");
  return row;
}

Json Workspace::LibraryJson() {
  Json list = Json::array();
  for (const LibraryEntry& entry : Captures()) {
    const State state = Read(entry);
    const auto photos = PhotosOf(state);
    Json row = RowJson(entry, state, photos);
    std::error_code error;
    if (fs::is_regular_file(entry.folder / "glint" / "report" / "thumbnail.jpg", error)) {
      row["thumbnail"] = "/api/captures/" + entry.id + "/thumbnail";
    } else if (!photos.empty()) {
      const CheckedPhoto first = checks_->Peek(photos[0].file, state.task);
      if (!first.thumbnail.empty()) {
        row["thumbnail"] = "/api/captures/" + entry.id + "/thumbnail/" + photos[0].id;
      }
    }
    list.push_back(row);
  }
  return {{"captures", list}};
}

// What is said of the photographs together; it takes a while for hundreds of them.
std::shared_ptr<const Workspace::Judgement> Workspace::Judged(
    const State& state, const std::vector<StudioPhoto>& photos,
    const std::vector<NamedCheck>& checked, const std::vector<size_t>& index,
    const std::string& key) {
  auto judgement = std::make_shared<Judgement>();
  judgement->key = key;
  judgement->verdicts = JudgePhotos(checked, state.task);
  std::vector<NamedCheck> used;
  std::vector<LeftOutPhoto> left_out;
  for (size_t i = 0; i < checked.size(); ++i) {
    const PhotoVerdict& verdict = judgement->verdicts[i];
    const bool bad = verdict.state == PhotoVerdict::State::kBad;
    if (!bad && !photos[index[i]].left_out) used.push_back(checked[i]);
    if (bad) left_out.push_back({checked[i].name, verdict.reason});
  }
  if (state.capture) {
    judgement->advice = AdviseFor(*state.capture, used, left_out);
  } else if (state.draft) {
    Capture nothing_known;
    nothing_known.photos = {"photographs"};  // not an imported set
    judgement->advice = AdviseFor(nothing_known, used, left_out);
  }
  return judgement;
}

void Workspace::AddPhotographs(const LibraryEntry& entry, const State& state,
                               const std::vector<StudioPhoto>& photos,
                               const std::string& thumbnails, Json* json) {
  std::vector<Json> list;
  std::vector<NamedCheck> checked;
  std::vector<size_t> index;
  std::map<std::string, std::string> ids;
  std::string key = KeyOfJudgement(state.capture, state.task);
  for (const StudioPhoto& photo : photos) {
    list.push_back(PhotoJson(photo, thumbnails));
    ids[photo.name] = photo.id;
    if (SplitPhotoName(photo.file).frame >= 0) {  // of a video: a stage will look at it
      list.back()["state"] = "good";
      continue;
    }
    const CheckedPhoto one =
        checks_->Look(entry.id, photo.file, state.task, StudioFolderOf(entry.folder) / "checks");
    if (one.state != CheckState::kDone) {
      list.back()["state"] = one.state == CheckState::kWaiting ? "waiting" : "checking";
      continue;
    }
    AddCheck(one, &list.back());
    checked.push_back({photo.name, *one.check});
    index.push_back(list.size() - 1);
    key += photo.place + "\n" + one.content + (photo.left_out ? "-\n" : "+\n");
  }
  const auto judgement = [&] {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto& kept = judgements_[entry.id];
    return kept && kept->key == key ? kept : nullptr;
  }();
  const auto judged = judgement ? judgement : Judged(state, photos, checked, index, key);
  for (size_t i = 0; i < checked.size(); ++i) AddVerdict(judged->verdicts[i], ids, &list[index[i]]);
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    judgements_[entry.id] = judged;
  }
  for (Json& photo : list) photo.erase("url_of_thumbnail");
  (*json)["photographs"] = list;
  (*json)["advice"] = AdviceJson(judged->advice);
  if (!photos.empty() && lock_) {
    KeepIfPossible(AdviceFile(entry.folder), {{"verdict", judged->advice.verdict}});
  }
}

// The kept board whose description the capture has.
Json Workspace::BoardOf(const fs::path& capture) const {
  std::error_code error;
  const fs::path own = capture / "board.json";
  if (!fs::is_regular_file(own, error)) return nullptr;
  const std::string text = ReadTextFile(own);
  for (const KeptBoard& board : boards_.List()) {
    if (ReadTextFile(board.folder / "board.json") == text) return board.id;
  }
  return nullptr;
}

Json Workspace::CaptureJson(const LibraryEntry& entry, const std::string& files,
                            const std::string& thumbnails) {
  const State state = Read(entry);
  const auto photos = PhotosOf(state);
  Json json = RowJson(entry, state, photos);
  json["folder"] = entry.folder.string();
  json["options"] = Json::object();
  json["problem"] = nullptr;
  json["limits"] = {{"photograph_bytes", kMostPhoto_bytes}, {"photographs", kMostPhotographs}};
  json["board"] = BoardOf(entry.folder);
  if (!state.problem.message.empty()) {
    json["problem"] = {{"message", state.problem.message}, {"remedy", state.problem.remedy}};
  }
  AddPhotographs(entry, state, photos, thumbnails, &json);
  json["verdict"] = json["advice"]["verdict"];
  if (state.capture) json["options"] = SavedOptions(*state.capture);
  const auto run = runs_->Look(entry.id, entry.folder);
  json["run"] = run ? ToJson(*run) : Json();
  json["result"] = ResultJson(entry.folder, files);
  if (!json["result"].is_null()) json["thumbnail"] = files + "report/thumbnail.jpg";
  return json;
}

Json Workspace::PhoneJson(const LibraryEntry& entry, const std::string& thumbnails) {
  const State state = Read(entry);
  Json json = {
      {"name", entry.name},
      {"kind", state.draft     ? state.draft->kind
               : state.capture ? KindOf(*state.capture)
                               : "board"},
      {"limits", {{"photograph_bytes", kMostPhoto_bytes}, {"photographs", kMostPhotographs}}}};
  AddPhotographs(entry, state, PhotosOf(state), thumbnails, &json);
  return json;
}

void Workspace::PrepareOptions() {
  // The first page comes first.
  preparing_ = std::thread([this] {
    constexpr auto kLater = std::chrono::seconds(2);
    {
      std::unique_lock<std::mutex> guard(mutex_);
      if (end_.wait_for(guard, kLater, [&] { return ending_.load(); })) return;
    }
    Options();
  });
}

const Json& Workspace::Options() {
  std::call_once(options_made_,
                 [this] { options_ = OptionForm([this] { return ending_.load(); }); });
  return options_;
}

std::string Workspace::Make(const NewCapture& wanted) {
  const fs::path folder = MakeCapture(root_, wanted);
  const std::string id = IdOf(folder.lexically_relative(root_).generic_string());
  Captures(true);
  events_.Publish("library", id);
  return id;
}

void Workspace::Trash(const LibraryEntry& entry) {
  if (runs_->IsRunning(entry.id) || RunsElsewhere(entry.folder)) {
    throw HttpError{409, "the capture is being run", "cancel the run first"};
  }
  if (entry.folder == root_) {
    throw HttpError{409, "the capture is Studio's own folder", "move it yourself"};
  }
  const auto mutex = MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  MoveToTrash(root_, entry);
  Captures(true);
  events_.Publish("library", entry.id);
}

// Takes what others have changed meanwhile into account: reads, edits, and writes if the file is
// still the one that was read.
void Workspace::EditCapture(
    const LibraryEntry& entry,
    const std::function<std::string(const Capture&, const std::string&)>& edit) {
  constexpr int kAttempts = 5;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Capture capture = ReadCapture(entry.folder, Photographs::kMayBeMissing);
    const std::string text = ReadTextFile(capture.file);
    const std::string changed = edit(capture, text);
    if (changed == text) return;
    if (ReadTextFile(capture.file) != text) continue;
    WriteFileAtomically(capture.file, changed);
    return;
  }
  throw HttpError{409, "capture.toml is being changed by somebody else", "try again"};
}

void Workspace::ListNewPhoto(const LibraryEntry& entry, const fs::path& file) {
  if (IsDraft(entry.folder)) return FinishDraft(entry.folder);
  const std::string place = file.lexically_relative(entry.folder).generic_string();
  EditCapture(entry, [&](const Capture& capture, const std::string& text) {
    const auto has = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), place) != list.end();
    };
    if (has(capture.photos) || has(capture.left_out_photos)) return text;
    return WithTomlListItem(capture.file, text, "photos", "files",
                            "photos/*" + file.extension().string());
  });
}

Json Workspace::KeepReceived(const LibraryEntry& entry, const std::string& name,
                             ReceivedPhoto* photo) {
  const std::string hash = photo->Finish();
  const auto mutex = MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  const State state = Read(entry);
  if (!state.problem.message.empty()) {
    throw HttpError{409, state.problem.message, state.problem.remedy};
  }
  const auto photos = PhotosOf(state);
  for (const StudioPhoto& one : photos) {
    std::error_code error;
    if (fs::file_size(one.file, error) == photo->size() && !error && HashFile(one.file) == hash) {
      return {{"name", name}, {"id", one.id}, {"error", nullptr}, {"same", true}};
    }
  }
  if (photos.size() >= kMostPhotographs) {
    throw HttpError{413, "the capture has 1000 photographs", "make another capture"};
  }
  const bool single = state.draft ? state.draft->kind == "single"
                                  : state.capture && IsOfOnePhotograph(*state.capture);
  const bool one_is_used = std::any_of(photos.begin(), photos.end(),
                                       [](const StudioPhoto& other) { return !other.left_out; });
  if (single && one_is_used) {
    throw HttpError{409, "this capture is of one photograph, which is there",
                    "leave that one out first, or make a capture with a board for several"};
  }
  const fs::path file = photo->Keep();
  const std::string place = file.lexically_relative(entry.folder).generic_string();
  std::set<std::string> undecided = Undecided(entry.folder);
  undecided.insert(place);
  KeepIfPossible(UndecidedFile(entry.folder), Json(undecided));
  try {
    ListNewPhoto(entry, file);
  } catch (...) {  // whoever sent it is told, and still has it
    ::unlink(file.c_str());
    throw;
  }
  const CheckTask task = Read(entry).task;
  checks_->Look(entry.id, file, task, StudioFolderOf(entry.folder) / "checks");
  return {{"name", name}, {"id", IdOf(place)}, {"error", nullptr}};
}

Json Workspace::Receive(const LibraryEntry& entry, HttpBody* body) {
  if (!lock_) throw HttpError{403, "the folder can only be read", "make it writable"};
  constexpr size_t kMostParts = 1000;
  Json list = Json::array();
  std::string name;
  std::unique_ptr<ReceivedPhoto> photo;
  std::optional<HttpError> last_failure;
  const auto fail = [&](const HttpError& error) {
    const std::string remedy = error.remedy.empty() ? "" : "; " + error.remedy;
    list.push_back({{"name", name}, {"id", nullptr}, {"error", error.message + remedy}});
    last_failure = error;
    photo.reset();
  };
  const auto finish = [&] {
    if (!photo) return;
    try {
      list.push_back(KeepReceived(entry, name, photo.get()));
      photo.reset();
    } catch (const HttpError& error) {
      fail(error);
    } catch (const Error& error) {
      const ProgramMessage said = SplitMessage(error.what());
      fail({500, said.message, said.remedy});
    }
    events_.Publish("capture", entry.id);
  };
  const bool all = body->Parts(
      [&](const HttpPart& part) {
        finish();
        if (part.field != "photographs" || list.size() >= kMostParts) return true;
        name = part.file_name.substr(0, 200);
        photo = std::make_unique<ReceivedPhoto>(entry.folder / "photos", part.file_name);
        return true;
      },
      [&](std::string_view bytes) {
        if (!photo) return true;  // of a part that failed already: read over
        try {
          photo->Append(bytes);
        } catch (const HttpError& error) {
          fail(error);
          return error.status != 507;
        }
        return true;
      });
  if (all) {
    finish();
  } else if (photo) {
    fail({400, "the connection ended before the photograph was there", "send it again"});
  }
  if (list.empty()) {
    throw HttpError{all ? 415 : 400, "found no photographs in the request",
                    "send them in the field photographs"};
  }
  // Of one photograph alone, what is not its own fault is the request's.
  const bool not_its_own =
      last_failure && (last_failure->status >= 500 || last_failure->status == 413);
  if (list.size() == 1 && not_its_own) throw *last_failure;
  return {{"photographs", list}};
}

void Workspace::SetLeftOut(const LibraryEntry& entry, const std::string& photo, bool left_out) {
  const auto mutex = MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  if (IsDraft(entry.folder)) {
    throw HttpError{409, "the capture has no photograph yet", "send one first"};
  }
  std::string place;
  for (const StudioPhoto& one : PhotosOf(Read(entry))) {
    if (one.id == photo) place = one.place;
  }
  if (place.empty()) throw HttpError{404, "there is no such photograph", "reload the page"};
  EditCapture(entry, [&](const Capture& capture, const std::string& text) {
    std::set<std::string> names(capture.left_out_photos.begin(), capture.left_out_photos.end());
    if (left_out) {
      names.insert(place);
    } else {
      names.erase(place);
    }
    return WithTomlValue(capture.file, text, "photos", "left_out",
                         names.empty() ? std::nullopt : std::optional<Json>(Json(names)));
  });
  std::set<std::string> undecided = Undecided(entry.folder);
  if (undecided.erase(place) > 0) KeepIfPossible(UndecidedFile(entry.folder), Json(undecided));
  events_.Publish("capture", entry.id);
}

// Bad photographs that came in through Studio and that nobody has decided about are left out; what
// was there before Studio is not touched.
void Workspace::LeaveOutBad(const std::string& capture) {
  try {
    const LibraryEntry entry = Find(capture);
    const auto mutex = MutexOf(capture);
    const std::lock_guard<std::mutex> guard(*mutex);
    std::set<std::string> undecided = Undecided(entry.folder);
    if (undecided.empty() || IsDraft(entry.folder)) return;
    const State state = Read(entry);
    if (!state.capture || !state.capture->has_board) return;
    std::vector<NamedCheck> checked;
    std::vector<std::string> places;
    for (const StudioPhoto& photo : PhotosOf(state)) {
      const CheckedPhoto one = checks_->Peek(photo.file, state.task);
      if (one.state != CheckState::kDone) continue;
      checked.push_back({photo.name, *one.check});
      places.push_back(photo.place);
    }
    const auto verdicts = JudgePhotos(checked, state.task);
    std::set<std::string> bad;
    for (size_t i = 0; i < places.size(); ++i) {
      if (undecided.erase(places[i]) == 0) continue;
      if (verdicts[i].state == PhotoVerdict::State::kBad) bad.insert(places[i]);
    }
    if (!bad.empty()) {
      EditCapture(entry, [&](const Capture& now, const std::string& text) {
        std::set<std::string> names(now.left_out_photos.begin(), now.left_out_photos.end());
        names.insert(bad.begin(), bad.end());
        return WithTomlValue(now.file, text, "photos", "left_out", Json(names));
      });
    }
    KeepIfPossible(UndecidedFile(entry.folder), Json(undecided));
  } catch (const std::exception&) {  // the next photograph's check tries again
  } catch (const HttpError&) {       // the capture has gone
  }
}

void Workspace::SetOptions(const LibraryEntry& entry, const Json& changes) {
  const Json& form = Options();
  const auto mutex = MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  if (IsDraft(entry.folder)) {
    throw HttpError{409, "the capture has no photograph yet", "send one first"};
  }
  EditCapture(entry, [&](const Capture& capture, const std::string& text) {
    return WithOptions(capture, text, changes, form);
  });
  events_.Publish("capture", entry.id);
}

void Workspace::Run(const LibraryEntry& entry, bool quick) {
  if (!lock_) throw HttpError{403, "the folder can only be read", "make it writable"};
  if (IsDraft(entry.folder)) {
    throw HttpError{409, "the capture has no photograph yet", "send one first"};
  }
  runs_->Start(entry.id, entry.folder, quick);
  events_.Publish("run", entry.id);
}

fs::path Workspace::Thumbnail(const LibraryEntry& entry, const std::string& photo) {
  if (photo.empty()) return entry.folder / "glint" / "report" / "thumbnail.jpg";
  const State state = Read(entry);
  for (const StudioPhoto& one : PhotosOf(state)) {
    if (one.id == photo) return checks_->Peek(one.file, state.task).thumbnail;
  }
  return {};
}

}  // namespace glint
