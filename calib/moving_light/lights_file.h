// Where the light stood in each photograph of a camera that stood still, as programs for
// reflectance transformation imaging (RTI) write it.
//
//   .lp       RTIBuilder, Relight and others: the number of lights, then a line of file name and
//             vector for each
//   .relight  a project of RelightLab: its images' directions or positions
//   .dome     a dome of RelightLab: its lamps in the order in which they are lit, without names
//
// In all of them x points to the right of the picture, y up and z toward the camera.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glint {

struct ListedLight {
  std::string photo;  // as the file has it, its folders taken off; empty: the file has no names
  Eigen::Vector3d direction{0, 0, 1};          // a unit vector from the sample to the light
  std::optional<Eigen::Vector3d> position_mm;  // from the middle of the picture
};

struct LightsFile {
  std::filesystem::path file;
  std::vector<ListedLight> lights;
  std::vector<std::string> remarks;  // what a person should know of it; a sentence each
  bool has_names() const { return !lights.empty() && !lights[0].photo.empty(); }
};

// `unit`: "mm", "cm" or "m" where an .lp file holds positions; empty: directions. Relight's
// positions are lengths of a picture whose width it tells; they are scaled to `picture_width_mm`.
// Throws UserError: an ending that is not one of the above, a count that is not that of the lines,
// a line that is no vector, a vector of no length, directions that are none.
LightsFile ReadLightsFile(const std::filesystem::path& file, const std::string& unit,
                          double picture_width_mm);

// The endings as messages list them: ".lp, .relight or .dome".
std::string LightsFileEndings();

// Which of the file's lights each photograph has; −1: none. By name, without regard to case, then
// without the ending; where the file has no names, or none of them is a photograph's and there are
// as many lights as photographs, in order (and said so in `remarks`). `photos` are paths, sorted.
// Throws UserError: a light whose photograph is missing beside others that are there, two
// photographs of one name, a number of lights without names that is not that of the photographs.
std::vector<int> MatchLights(const LightsFile& file, const std::vector<std::string>& photos,
                             std::vector<std::string>* remarks);

}  // namespace glint
