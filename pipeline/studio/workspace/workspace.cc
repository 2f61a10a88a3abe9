#include "pipeline/studio/workspace/workspace.h"

#include <sys/statvfs.h>
#include <unistd.h>

#include <set>

#include "base/errors/errors.h"
#include "base/photos/photo_name.h"
#include "pipeline/studio/captures/capture_edit.h"
#include "pipeline/studio/captures/notes.h"
#include "pipeline/studio/captures/option_form.h"
#include "pipeline/studio/runs/results.h"
#include "pipeline/studio/workspace/board_offer.h"
#include "pipeline/studio/workspace/capture_row.h"
#include "pipeline/studio/workspace/killed_studio.h"
#include "pipeline/studio/workspace/left_out.h"
#include "pipeline/studio/workspace/photo_intake.h"
#include "pipeline/studio/workspace/photo_json.h"
#include "pipeline/studio/workspace/upload.h"

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

Json LimitsJson() {
  return {{"photograph_bytes", kMostPhoto_bytes}, {"photographs", kMostPhotographs}};
}

Json ProblemJson(const CaptureState& state) {
  if (state.problem.message.empty()) return nullptr;
  return {{"message", state.problem.message}, {"remedy", state.problem.remedy}};
}

fs::path ReportThumbnail(const fs::path& capture) {
  return capture / "glint" / "report" / "thumbnail.jpg";
}

}  // namespace

Workspace::Workspace(const fs::path& root, int check_threads)
    : root_(fs::canonical(root)),
      lock_(LockFolder(root_)),
      captures_(root_),
      boards_(root_ / kStudioFolder / "boards", [this] { return captures_.All(); }) {
  if (lock_) TidyAfterKilledStudio(root_, captures_.All());
  runs_ = std::make_unique<RunManager>(
      [this](const std::string& capture) { events_.Publish("run", capture); });
  checks_ = std::make_unique<CheckQueue>(
      check_threads, [this](const std::string& capture) { OnChecked(capture); });
}

Workspace::~Workspace() {
  events_.Close();
  options_.Stop();
  checks_->Stop();  // before it is gone: what it calls back asks it
  runs_.reset();
}

void Workspace::OnChecked(const std::string& capture) {
  try {
    const LibraryEntry entry = Find(capture);
    const auto mutex = captures_.MutexOf(capture);
    const std::lock_guard<std::mutex> guard(*mutex);
    LeaveOutBad(entry.folder, checks_.get());
  } catch (const std::exception&) {  // the next photograph's check tries again
  } catch (const HttpError&) {       // the capture has gone
  }
  events_.Publish("photograph", capture);
}

void Workspace::RequireWritable() const {
  if (!lock_) throw HttpError{403, "the folder can only be read", "make it writable"};
}

Json Workspace::StudioJson() const {
  struct statvfs facts {};
  std::uint64_t free_bytes = 0;
  if (::statvfs(root_.c_str(), &facts) == 0) {
    free_bytes = static_cast<std::uint64_t>(facts.f_bavail) * facts.f_frsize;
  }
  return {{"folder", root_.string()}, {"free_bytes", free_bytes}, {"read_only", lock_ == nullptr}};
}

Json Workspace::ThumbnailJson(const LibraryEntry& entry, const std::vector<StudioPhoto>& photos) {
  const std::string address = "/api/captures/" + entry.id + "/thumbnail";
  std::error_code error;
  if (fs::is_regular_file(ReportThumbnail(entry.folder), error)) return address;
  if (photos.empty() || !lock_ || SplitPhotoName(photos[0].file).frame >= 0) return nullptr;
  const SmallPicture first =
      checks_->LookAtPicture(entry.id, photos[0].file, CheckFolderOf(entry.folder));
  if (first.thumbnail.empty()) return nullptr;
  return address + "/" + photos[0].id + "?v=" + first.content.substr(0, 8);
}

Json Workspace::LibraryJson() {
  Json list = Json::array();
  for (const LibraryEntry& entry : captures_.All()) {
    const CaptureState state = ReadState(entry.folder);
    const auto photos = PhotosOf(state);
    Json row = RowJson(entry, state, photos, runs_.get());
    row["thumbnail"] = ThumbnailJson(entry, photos);
    list.push_back(row);
  }
  return {{"captures", list}};
}

void Workspace::AddPhotographs(const LibraryEntry& entry, const CaptureState& state,
                               const std::vector<StudioPhoto>& photos,
                               const std::string& thumbnails, Json* json) {
  const PhotoReview review = reviewer_.Review(entry.id, state, photos, thumbnails, checks_.get());
  (*json)["photographs"] = review.photographs;
  (*json)["advice"] = AdviceJson(review.advice);
  if (!photos.empty() && lock_) NoteVerdict(entry.folder, review.advice.verdict);
}

Json Workspace::BoardJson(const CaptureState& state) const {
  const CheckTask task = TaskOf(state);
  if (!task.board) return nullptr;
  if (const auto kept = boards_.Same(*task.board)) return ToJson(*kept);
  Json json = ToJson(KeptBoard{"", "", {}, BoardFile{*task.board, std::nullopt}});
  json["known"] = false;
  return json;
}

Json Workspace::CaptureJson(const LibraryEntry& entry, const std::string& files,
                            const std::string& thumbnails) {
  const CaptureState state = ReadState(entry.folder);
  const auto photos = PhotosOf(state);
  Json json = RowJson(entry, state, photos, runs_.get());
  const auto run = runs_->Look(entry.id, entry.folder);
  json["folder"] = entry.folder.string();
  json["problem"] = ProblemJson(state);
  json["limits"] = LimitsJson();
  json["board"] = BoardJson(state);
  AddPhotographs(entry, state, photos, thumbnails, &json);
  json["verdict"] = json["advice"]["verdict"];
  json["options"] = state.capture ? SavedOptions(*state.capture) : Json::object();
  json["run"] = run ? ToJson(*run) : Json();
  json["result"] = ResultJson(entry.folder, files);
  if (!json["result"].is_null()) json["thumbnail"] = files + "report/thumbnail.jpg";
  return json;
}

Json Workspace::PhoneJson(const LibraryEntry& entry, const std::string& thumbnails) {
  const CaptureState state = ReadState(entry.folder);
  Json json = {{"name", entry.name}, {"kind", KindOf(state)}, {"limits", LimitsJson()}};
  AddPhotographs(entry, state, PhotosOf(state), thumbnails, &json);
  return json;
}

std::string Workspace::Make(const NewCapture& wanted) {
  const fs::path folder = MakeCapture(root_, wanted);
  const std::string id = IdOf(folder.lexically_relative(root_).generic_string());
  captures_.All(true);
  events_.Publish("library", id);
  return id;
}

void Workspace::RequireNoRun(const LibraryEntry& entry) {
  if (runs_->IsRunning(entry.id) || RunsElsewhere(entry.folder)) {
    throw HttpError{409, "the capture is being run", "cancel the run first"};
  }
}

void Workspace::Trash(const LibraryEntry& entry) {
  RequireNoRun(entry);
  if (entry.folder == root_) {
    throw HttpError{409, "the capture is Studio's own folder", "move it yourself"};
  }
  const auto mutex = captures_.MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  MoveToTrash(root_, entry);
  captures_.All(true);
  events_.Publish("library", entry.id);
}

Json Workspace::Receive(const LibraryEntry& entry, HttpBody* body) {
  RequireWritable();
  const auto take = [&](ReceivedPhoto* photo) {
    const std::string hash = photo->Finish();
    const auto mutex = captures_.MutexOf(entry.id);
    const std::lock_guard<std::mutex> guard(*mutex);
    return TakeIn(entry, hash, photo, checks_.get());
  };
  return Upload(entry.folder / "photos", take, [&] { events_.Publish("capture", entry.id); })
      .Read(body);
}

void Workspace::SetLeftOut(const LibraryEntry& entry, const std::string& photo, bool left_out) {
  const auto mutex = captures_.MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  RequireDescription(entry.folder);
  std::string place;
  for (const StudioPhoto& one : PhotosOf(ReadState(entry.folder))) {
    if (one.id == photo) place = one.place;
  }
  if (place.empty()) throw HttpError{404, "there is no such photograph", "reload the page"};
  EditLeftOut(entry.folder, [&](std::set<std::string>* places) {
    if (left_out) {
      places->insert(place);
    } else {
      places->erase(place);
    }
  });
  std::set<std::string> undecided = UndecidedPhotos(entry.folder);
  if (undecided.erase(place) > 0) NoteUndecided(entry.folder, undecided);
  events_.Publish("capture", entry.id);
}

void Workspace::SetOptions(const LibraryEntry& entry, const Json& changes) {
  const Json& form = options_.Form();
  const auto mutex = captures_.MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  RequireDescription(entry.folder);
  EditCapture(entry.folder, [&](const Capture& capture, const std::string& text) {
    return WithOptions(capture, text, changes, form);
  });
  events_.Publish("capture", entry.id);
}

Json Workspace::BoardsToOfferJson(const LibraryEntry& entry) {
  Json list = Json::array();
  const BoardOffer offer = BoardsToOffer(ReadState(entry.folder), boards_.List(), checks_.get());
  for (const KeptBoard& board : offer.boards) list.push_back(ToJson(board));
  return {{"another", offer.shows_another}, {"boards", list}};
}

void Workspace::SetBoard(const LibraryEntry& entry, const BoardChange& change) {
  RequireWritable();
  RequireNoRun(entry);
  const auto mutex = captures_.MutexOf(entry.id);
  const std::lock_guard<std::mutex> guard(*mutex);
  const CaptureState state = ReadState(entry.folder);
  if (KindOf(state) != "board") {
    throw HttpError{409, "the capture has no board", "make a capture with a board"};
  }
  const std::set<std::string> again = LeftOutForBoard(state, checks_.get());
  ChangeBoard(entry.folder, change);
  std::set<std::string> undecided = UndecidedPhotos(entry.folder);
  undecided.insert(again.begin(), again.end());
  NoteUndecided(entry.folder, undecided);
  EditLeftOut(entry.folder, [&](std::set<std::string>* places) {
    for (const std::string& place : again) places->erase(place);
  });
  events_.Publish("capture", entry.id);
}

void Workspace::Run(const LibraryEntry& entry, bool quick) {
  RequireWritable();
  RequireDescription(entry.folder);
  runs_->Start(entry.id, entry.folder, quick);
  events_.Publish("run", entry.id);
}

fs::path Workspace::Thumbnail(const LibraryEntry& entry, const std::string& photo) {
  if (photo.empty()) return ReportThumbnail(entry.folder);
  const CaptureState state = ReadState(entry.folder);
  for (const StudioPhoto& one : PhotosOf(state)) {
    if (one.id != photo) continue;
    const CheckedPhoto checked = checks_->Peek(one.file, TaskOf(state));
    if (!checked.thumbnail.empty()) return checked.thumbnail;
    return checks_->LookAtPicture(entry.id, one.file, CheckFolderOf(entry.folder)).thumbnail;
  }
  return {};
}

}  // namespace glint
