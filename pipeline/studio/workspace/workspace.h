// Everything that Studio does with a folder of captures, without HTTP's addresses: what pages show
// as JSON, and what they change.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/files/files.h"
#include "pipeline/studio/captures/board_change.h"
#include "pipeline/studio/captures/boards.h"
#include "pipeline/studio/captures/new_capture.h"
#include "pipeline/studio/http/http_types.h"
#include "pipeline/studio/photographs/check_queue.h"
#include "pipeline/studio/runs/runs.h"
#include "pipeline/studio/workspace/capture_list.h"
#include "pipeline/studio/workspace/events.h"
#include "pipeline/studio/workspace/options_meanwhile.h"
#include "pipeline/studio/workspace/photo_review.h"

namespace glint {

class Workspace {
 public:
  // Throws UserError where another Studio has the folder, EnvironmentError where it is none.
  Workspace(const std::filesystem::path& root, int check_threads);
  ~Workspace();

  const std::filesystem::path& root() const { return root_; }
  EventHub& events() { return events_; }
  BoardShelf& boards() { return boards_; }
  RunManager& runs() { return *runs_; }
  OptionsMeanwhile& options() { return options_; }

  // Throws HttpError 404.
  LibraryEntry Find(const std::string& capture) { return captures_.Find(capture); }

  Json StudioJson() const;  // free_bytes, read_only …
  Json LibraryJson();
  // `files`: what stands before the names of its files in addresses; `thumbnails`: before the ids
  // of its photographs.
  Json CaptureJson(const LibraryEntry& entry, const std::string& files,
                   const std::string& thumbnails);
  Json PhoneJson(const LibraryEntry& entry, const std::string& thumbnails);

  std::string Make(const NewCapture& wanted);  // its id
  void Trash(const LibraryEntry& entry);
  // Photographs from a multipart body; what each became.
  Json Receive(const LibraryEntry& entry, HttpBody* body);
  void SetLeftOut(const LibraryEntry& entry, const std::string& photo, bool left_out);
  void SetOptions(const LibraryEntry& entry, const Json& changes);
  // Boards that its photographs show where they show another than the capture's.
  Json BoardsToOfferJson(const LibraryEntry& entry);
  // Photographs that were left out because its board was not found in them are judged again.
  void SetBoard(const LibraryEntry& entry, const BoardChange& change);
  void Run(const LibraryEntry& entry, bool quick);
  // A small picture of a photograph, or of the result; empty: there is none (yet).
  std::filesystem::path Thumbnail(const LibraryEntry& entry, const std::string& photo);

 private:
  void OnChecked(const std::string& capture);
  void RequireWritable() const;
  void RequireNoRun(const LibraryEntry& entry);
  Json BoardJson(const CaptureState& state) const;
  Json ThumbnailJson(const LibraryEntry& entry, const std::vector<StudioPhoto>& photos);
  void AddPhotographs(const LibraryEntry& entry, const CaptureState& state,
                      const std::vector<StudioPhoto>& photos, const std::string& thumbnails,
                      Json* json);

  std::filesystem::path root_;
  std::unique_ptr<FileLock> lock_;  // null: the folder can only be read
  EventHub events_;
  CaptureList captures_;
  BoardShelf boards_;
  PhotoReviewer reviewer_;
  OptionsMeanwhile options_;
  std::unique_ptr<RunManager> runs_;
  std::unique_ptr<CheckQueue> checks_;  // ends first: it calls back
};

}  // namespace glint
