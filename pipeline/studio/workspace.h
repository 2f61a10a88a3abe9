// Everything that Studio does with a folder of captures, without HTTP's addresses: what pages show
// as JSON, and what they change.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/files/files.h"
#include "pipeline/studio/advise.h"
#include "pipeline/studio/boards.h"
#include "pipeline/studio/check_queue.h"
#include "pipeline/studio/events.h"
#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/library.h"
#include "pipeline/studio/new_capture.h"
#include "pipeline/studio/runs.h"

namespace glint {

class ReceivedPhoto;

struct StudioPhoto {
  std::string id, name;  // the file's
  std::string place;     // relative to the capture, as capture.toml lists it
  std::filesystem::path file;
  bool left_out = false;
  double added_s = 0;  // since 1970
};

class Workspace {
 public:
  // Throws UserError where another Studio has the folder, EnvironmentError where it is none.
  Workspace(const std::filesystem::path& root, int check_threads);
  ~Workspace();

  const std::filesystem::path& root() const { return root_; }
  EventHub& events() { return events_; }
  BoardShelf& boards() { return boards_; }
  RunManager& runs() { return *runs_; }

  // Throws HttpError 404.
  LibraryEntry Find(const std::string& capture);

  Json StudioJson() const;  // free_bytes, read_only …
  Json LibraryJson();
  // `files`: what stands before the names of its files in addresses; `thumbnails`: before the ids
  // of its photographs.
  Json CaptureJson(const LibraryEntry& entry, const std::string& files,
                   const std::string& thumbnails);
  Json PhoneJson(const LibraryEntry& entry, const std::string& thumbnails);
  const Json& Options();  // the form; takes seconds the first time
  void PrepareOptions();  // makes it meanwhile; once

  std::string Make(const NewCapture& wanted);  // its id
  void Trash(const LibraryEntry& entry);
  // Photographs from a multipart body; what each became.
  Json Receive(const LibraryEntry& entry, HttpBody* body);
  void SetLeftOut(const LibraryEntry& entry, const std::string& photo, bool left_out);
  void SetOptions(const LibraryEntry& entry, const Json& changes);
  void Run(const LibraryEntry& entry, bool quick);
  // A small picture of a photograph that has been checked; empty: there is none.
  std::filesystem::path Thumbnail(const LibraryEntry& entry, const std::string& photo);

 private:
  struct State;  // of a capture, as it is now
  struct Judgement {
    std::string key;  // of everything it depends on
    std::vector<PhotoVerdict> verdicts;
    StudioAdvice advice;
  };
  std::vector<LibraryEntry> Captures(bool again = false);
  static std::shared_ptr<const Judgement> Judged(const State& state,
                                                 const std::vector<StudioPhoto>& photos,
                                                 const std::vector<NamedCheck>& checked,
                                                 const std::vector<size_t>& index,
                                                 const std::string& key);
  State Read(const LibraryEntry& entry) const;
  std::vector<StudioPhoto> PhotosOf(const State& state) const;
  Json RowJson(const LibraryEntry& entry, const State& state,
               const std::vector<StudioPhoto>& photos);
  std::string StatusOf(const LibraryEntry& entry, const State& state,
                       const std::vector<StudioPhoto>& photos);
  void AddPhotographs(const LibraryEntry& entry, const State& state,
                      const std::vector<StudioPhoto>& photos, const std::string& thumbnails,
                      Json* json);
  Json BoardOf(const std::filesystem::path& capture) const;
  Json KeepReceived(const LibraryEntry& entry, const std::string& name, ReceivedPhoto* photo);
  void ListNewPhoto(const LibraryEntry& entry, const std::filesystem::path& file);
  void LeaveOutBad(const std::string& capture);
  void EditCapture(const LibraryEntry& entry,
                   const std::function<std::string(const Capture&, const std::string&)>& edit);
  std::shared_ptr<std::mutex> MutexOf(const std::string& capture);

  std::filesystem::path root_;
  std::unique_ptr<FileLock> lock_;
  EventHub events_;
  BoardShelf boards_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<std::mutex>> captures_;
  std::map<std::string, std::shared_ptr<const Judgement>> judgements_;  // by capture
  std::vector<LibraryEntry> listed_;
  std::chrono::steady_clock::time_point listed_at_;
  std::once_flag options_made_;
  Json options_;
  std::thread preparing_;
  std::atomic<bool> ending_ = false;
  std::condition_variable end_;
  std::unique_ptr<RunManager> runs_;
  std::unique_ptr<CheckQueue> checks_;  // ends first: it calls back
};

}  // namespace glint
