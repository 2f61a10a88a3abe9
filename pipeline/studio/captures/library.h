// The captures beneath a folder, and what Studio keeps beside them.
//
//   FOLDER/.glint-studio/        boards/, trash of torn uploads, the lock
//   FOLDER/.glint-trash/         captures that were thrown away, as they were
//   CAPTURE/.glint-studio.json   of a capture whose capture.toml cannot be written yet (draft.h)
//   CAPTURE/glint/.studio/       checks and thumbnails, the last run, the maps before it
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glint {

inline constexpr char kStudioFolder[] = ".glint-studio";
inline constexpr char kTrashFolder[] = ".glint-trash";
inline constexpr char kDraftFile[] = ".glint-studio.json";

struct LibraryEntry {
  std::string id;                // of its place beneath the folder: 16 hexadecimal digits
  std::string name;              // the folder's
  std::filesystem::path folder;  // absolute
};

// Every folder at or beneath `root`, five deep, that holds a capture.toml or a draft; sorted by
// place; of the first 20 000 folders that are met. What lies in a capture is not looked into, nor
// are hidden folders and links.
std::vector<LibraryEntry> FindCaptures(const std::filesystem::path& root);

// The opaque id of a name: nothing of a client's ever becomes a path but by being found in a list.
std::string IdOf(const std::string& name);

// CAPTURE/glint/.studio
std::filesystem::path StudioFolderOf(const std::filesystem::path& capture);

// Moves the capture into the trash, under its name and the time; returns where to. Nothing is
// deleted. Throws EnvironmentError.
std::filesystem::path MoveToTrash(const std::filesystem::path& root, const LibraryEntry& entry);

}  // namespace glint
