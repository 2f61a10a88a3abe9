// What Studio notes for itself beside a capture, in glint/.studio: it makes Studio quicker or
// spares it a decision, and may be lost.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace glint {

// The verdict of the photographs together, as Studio has last told it, else as `glint calib` has;
// "none": nobody has.
std::string NotedVerdict(const std::filesystem::path& capture);
void NoteVerdict(const std::filesystem::path& capture, const std::string& verdict);

// Places of photographs that came in through Studio and of which nobody has decided yet whether
// they are left out.
std::set<std::string> UndecidedPhotos(const std::filesystem::path& capture);
void NoteUndecided(const std::filesystem::path& capture, const std::set<std::string>& places);

}  // namespace glint
