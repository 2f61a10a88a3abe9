#include <algorithm>
#include <iterator>

#include "base/board/board_kind.h"

namespace glint {
namespace {

struct Row {
  BoardKind kind;
  const KindOfBoard& (*description)();
};

constexpr Row kRows[] = {
    {BoardKind::kCharuco, CharucoKind},
    {BoardKind::kCheckerboard, CheckerboardKind},
    {BoardKind::kMarkers, MarkerFrameKind},
};

}  // namespace

const KindOfBoard& KindOf(BoardKind kind) {
  return std::find_if(std::begin(kRows), std::end(kRows),
                      [&](const Row& row) { return row.kind == kind; })
      ->description();
}

const std::vector<BoardKind>& BoardKinds() {
  static const std::vector<BoardKind> kinds = [] {
    std::vector<BoardKind> list;
    for (const Row& row : kRows) list.push_back(row.kind);
    return list;
  }();
  return kinds;
}

std::vector<std::string> BoardKindNames(bool in_capture_toml) {
  std::vector<std::string> names;
  for (const Row& row : kRows) {
    const KindOfBoard& kind = row.description();
    if (!in_capture_toml || kind.fits_capture_toml()) names.emplace_back(kind.name());
  }
  return names;
}

std::optional<BoardKind> BoardKindNamed(const std::string& name) {
  for (const Row& row : kRows) {
    if (name == row.description().name()) return row.kind;
  }
  return std::nullopt;
}

}  // namespace glint
