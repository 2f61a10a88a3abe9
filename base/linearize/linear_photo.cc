#include "base/linearize/linear_photo.h"

#include <cmath>
#include <utility>

namespace glint {

LinearPhoto::LinearPhoto(Photo photo, const Encoding& encoding, const SaturationRule& saturation)
    : image_(std::move(photo.image)),
      colour_(std::move(photo.colour)),
      stored_linear_(encoding == Encoding::kLinear) {
  image_.Visit([&]<class T>(std::vector<T>& samples) {
    if constexpr (std::is_floating_point_v<T>) {
      LineariseFloats(encoding, saturation, &samples);
    } else {
      codes_ = static_cast<size_t>(std::numeric_limits<T>::max()) + 1;
      MakeTables(encoding, saturation);
    }
  });
}

void LinearPhoto::MakeTables(const Encoding& encoding, const SaturationRule& saturation) {
  const int codes = static_cast<int>(codes_);
  const int tables = encoding.kind() == Encoding::kResponse ? 3 : 1;
  for (int c = 0; c < tables; ++c) {
    const std::vector<float> table = LinearTable(encoding, codes, c);
    table_.insert(table_.end(), table.begin(), table.end());
  }
  saturated_code_ = static_cast<int>(std::ceil(saturation.stored_level * (codes - 1)));
}

void LinearPhoto::LineariseFloats(const Encoding& encoding, const SaturationRule& saturation,
                                  std::vector<float>* samples) {
  saturated_value_ = static_cast<float>(saturation.float_level);
  if (std::isfinite(saturation.float_level)) {
    saturated_value_ = LinearFromEncoded(encoding, saturated_value_);
  }
  for (size_t i = 0; i < samples->size(); ++i) {
    (*samples)[i] = LinearFromEncoded(encoding, (*samples)[i], static_cast<int>(i % 3));
  }
}

}  // namespace glint
