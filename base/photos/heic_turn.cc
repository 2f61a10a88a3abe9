#include "base/photos/heic_turn.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace glint {
namespace {

// What is looked at; the box that describes the pictures stands at the beginning, or behind them.
constexpr std::size_t kMostBytes = 64u << 20;

// Big-endian numbers, one after the other; all reads beyond the end give 0 and mark the failure.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t Number(size_t size) {
    if (bytes_.size() < size) {
      ok_ = false;
      bytes_ = {};
      return 0;
    }
    std::uint64_t value = 0;
    for (size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes_[i]);
    bytes_.remove_prefix(size);
    return value;
  }
  std::string_view Take(std::uint64_t size) {
    const std::string_view taken = bytes_.substr(0, size);
    if (taken.size() < size) ok_ = false;
    bytes_.remove_prefix(taken.size());
    return taken;
  }
  bool ok() const { return ok_; }
  bool empty() const { return bytes_.empty(); }
  size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

struct Box {
  std::string type;
  std::string_view content;
};

// The boxes of a container (ISO/IEC 14496-12, 4.2); stops at the first that is not whole.
std::vector<Box> Boxes(std::string_view container) {
  std::vector<Box> boxes;
  Reader reader(container);
  while (!reader.empty()) {
    const size_t before = reader.left();
    std::uint64_t size = reader.Number(4);
    const std::string type(reader.Take(4));
    if (size == 1) size = reader.Number(8);
    const std::uint64_t header = before - reader.left();
    if (size == 0) size = before;
    if (!reader.ok() || size < header) break;
    const std::string_view content = reader.Take(size - header);
    if (!reader.ok()) break;
    boxes.push_back({type, content});
  }
  return boxes;
}

std::optional<std::string_view> Find(const std::vector<Box>& boxes, const std::string& type) {
  for (const Box& box : boxes) {
    if (box.type == type) return box.content;
  }
  return std::nullopt;
}

std::uint64_t PrimaryItem(std::string_view pitm) {
  Reader reader(pitm);
  const std::uint64_t version = reader.Number(4) >> 24;
  return reader.Number(version == 0 ? 2 : 4);
}

// Indices, from 1, of the properties of an item, in order (ipma, ISO/IEC 23008-12, 9.3.3).
std::vector<size_t> PropertiesOf(std::string_view ipma, std::uint64_t item) {
  Reader reader(ipma);
  const std::uint64_t head = reader.Number(4);
  const size_t id_size = head >> 24 < 1 ? 2 : 4;
  const size_t index_size = (head & 1) != 0 ? 2 : 1;
  const std::uint64_t entries = reader.Number(4);
  for (std::uint64_t e = 0; e < entries && reader.ok(); ++e) {
    const bool wanted = reader.Number(id_size) == item;
    std::vector<size_t> properties;
    const std::uint64_t count = reader.Number(1);
    for (std::uint64_t i = 0; i < count && reader.ok(); ++i) {
      const std::uint64_t essential = index_size == 2 ? 0x8000 : 0x80;
      properties.push_back(reader.Number(index_size) & (essential - 1));
    }
    if (wanted && reader.ok()) return properties;
  }
  return {};
}

// What x and y become, x to the right and y downward: xx, xy, yx, yy.
using Turn = std::array<int, 4>;
constexpr Turn kUpright = {1, 0, 0, 1}, kFlip = {-1, 0, 0, 1}, kFlop = {1, 0, 0, -1},
               kAnticlockwise = {0, 1, -1, 0};
// EXIF's orientations 1 … 8.
constexpr std::array<Turn, 8> kTurnsOfExif = {{kUpright,
                                               kFlip,
                                               {-1, 0, 0, -1},
                                               kFlop,
                                               {0, 1, 1, 0},
                                               {0, -1, 1, 0},
                                               {0, -1, -1, 0},
                                               kAnticlockwise}};

Turn After(const Turn& first, const Turn& then) {
  return {then[0] * first[0] + then[1] * first[2], then[0] * first[1] + then[1] * first[3],
          then[2] * first[0] + then[3] * first[2], then[2] * first[1] + then[3] * first[3]};
}

}  // namespace

int HeicOrientation(std::string_view bytes) {
  auto meta = Find(Boxes(bytes), "meta");
  if (!meta || meta->size() < 4) return 1;
  const std::vector<Box> described = Boxes(meta->substr(4));  // version and flags go before
  const auto primary = Find(described, "pitm"), iprp = Find(described, "iprp");
  if (!primary || !iprp) return 1;
  const std::vector<Box> properties = Boxes(*iprp);
  const auto ipco = Find(properties, "ipco"), ipma = Find(properties, "ipma");
  if (!ipco || !ipma) return 1;
  const std::vector<Box> all = Boxes(*ipco);
  Turn turn = kUpright;
  for (const size_t index : PropertiesOf(*ipma, PrimaryItem(*primary))) {
    if (index < 1 || index > all.size() || all[index - 1].content.empty()) continue;
    const Box& property = all[index - 1];
    // In their order; a mirror's axis 1 exchanges left and right, as libheif has it.
    if (property.type == "imir") turn = After(turn, property.content[0] & 1 ? kFlip : kFlop);
    if (property.type == "irot") {
      for (int i = 0; i < (property.content[0] & 3); ++i) turn = After(turn, kAnticlockwise);
    }
  }
  return static_cast<int>(std::find(kTurnsOfExif.begin(), kTurnsOfExif.end(), turn) -
                          kTurnsOfExif.begin()) +
         1;
}

int HeicOrientation(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return 1;
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(std::min<std::uintmax_t>(size, kMostBytes), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<size_t>(stream.gcount()));
  return HeicOrientation(std::string_view(bytes));
}

}  // namespace glint
