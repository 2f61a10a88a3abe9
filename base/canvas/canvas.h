// Pictures drawn with OpenCV, as images that Glint writes.
#pragma once

#include "base/images/image.h"

namespace cv {
class Mat;
}

namespace glint {

// `canvas`: CV_8UC3, drawn with colours in the order red, green, blue. Values as they were drawn,
// on [0, 1]; channels R, G, B.
Image ImageOf(const cv::Mat& canvas);

}  // namespace glint
