#include "calib/corners/markers.h"

#include <algorithm>
#include <map>

#include "base/board/aruco.h"
#include "base/board/dictionary.h"

namespace glint {
namespace {

std::vector<SeenMarker> FindInReduced(const GrayImage& image, const std::string& dictionary,
                                      int longest_px) {
  int factor = 1;
  const GrayImage small = Reduced(image, longest_px, &factor);
  // OpenCV does not write to its input.
  const cv::Mat picture(small.height, small.width, CV_8U,
                        const_cast<unsigned char*>(small.samples.data()));
  const auto parameters = cv::makePtr<cv::aruco::DetectorParameters>();
  parameters->adaptiveThreshWinSizeMin = 5;
  parameters->adaptiveThreshWinSizeMax = 45;
  parameters->adaptiveThreshWinSizeStep = 10;
  parameters->minMarkerPerimeterRate = 40.0 / std::max(small.width, small.height);
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::aruco::detectMarkers(picture, aruco::Dictionary(DictionaryNumber(dictionary).value()),
                           corners, ids, parameters);
  std::map<int, int> seen;
  for (int id : ids) ++seen[id];
  std::vector<SeenMarker> markers;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (seen[ids[i]] != 1) continue;
    SeenMarker marker;
    marker.id = ids[i];
    // OpenCV's (0, 0) is the centre of the top-left pixel.
    for (int k = 0; k < 4; ++k) {
      marker.corners_px[k] = {(corners[i][k].x + 0.5) * factor, (corners[i][k].y + 0.5) * factor};
    }
    markers.push_back(marker);
  }
  std::sort(markers.begin(), markers.end(),
            [](const SeenMarker& a, const SeenMarker& b) { return a.id < b.id; });
  return markers;
}

}  // namespace

Eigen::Vector2d SeenMarker::centre_px() const {
  return 0.25 * (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]);
}

double SeenMarker::side_px() const {
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += (corners_px[k] - corners_px[(k + 1) % 4]).norm();
  return 0.25 * sum;
}

std::vector<SeenMarker> FindMarkers(const GrayImage& image, const std::string& dictionary,
                                    int longest_px, int enough) {
  if (std::min(image.width, image.height) < 16) return {};
  std::vector<SeenMarker> markers = FindInReduced(image, dictionary, longest_px);
  const int longest = std::max(image.width, image.height);
  if (static_cast<int>(markers.size()) < enough && longest > longest_px) {
    std::vector<SeenMarker> finer =
        FindInReduced(image, dictionary, std::min(longest, 2 * longest_px));
    if (finer.size() > markers.size()) markers = std::move(finer);
  }
  return markers;
}

std::string GuessDictionary(const GrayImage& image, int longest_px, int* markers) {
  if (std::min(image.width, image.height) < 16) return "";
  std::string best;
  *markers = 2;
  for (const std::string& name : DictionaryNames()) {
    const int seen = static_cast<int>(FindInReduced(image, name, longest_px).size());
    if (seen <= *markers) continue;  // the smallest dictionary that shows as many
    *markers = seen;
    best = name;
  }
  return best;
}

}  // namespace glint
