// A photograph on its way in: written beside its place, looked at, and put there whole or not at
// all; nothing that is there is ever written over.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace glint {

inline constexpr std::uint64_t kMostPhoto_bytes = 200u << 20;
inline constexpr std::size_t kMostPhotographs = 1000;  // of a capture

// The ending that photographs of this content have (".jpg"), by their first bytes; empty: nothing
// that a camera writes as a photograph. TIFF and RAW begin alike: there the ending of `name` is
// taken where it is one of theirs.
std::string PhotoEnding(std::string_view first_bytes, const std::string& name);

// "IMG_0001" of what a client calls "C:\\…/IMG_0001.HEIC": a plain name, never a path.
std::string PlainStem(const std::string& client_name);

class ReceivedPhoto {
 public:
  // Into `folder`, which is made where it is missing. Throws EnvironmentError.
  ReceivedPhoto(std::filesystem::path folder, std::string client_name);
  ~ReceivedPhoto();  // what was not kept is gone
  ReceivedPhoto(const ReceivedPhoto&) = delete;
  ReceivedPhoto& operator=(const ReceivedPhoto&) = delete;

  // Throws HttpError: too large, no photograph by its first bytes, disk full.
  void Append(std::string_view bytes);
  // All has come: synced and checked. Throws HttpError: empty, no picture, cut off, too many
  // pixels. Returns its hash.
  std::string Finish();
  // Gives it its name in the folder, "-2" … added where there is one of that name, and returns it.
  std::filesystem::path Keep();

  std::uint64_t size() const { return size_; }

  // Removes what uploads left that were killed.
  static void RemoveLeftovers(const std::filesystem::path& folder);

 private:
  void Write(std::string_view bytes);
  void Identify();

  std::filesystem::path folder_, temporary_;
  std::string client_name_, ending_, first_bytes_;
  std::uint64_t size_ = 0;
  int descriptor_ = -1;
};

}  // namespace glint
