#include "base/photos/heif_facts.h"

#include <libheif/heif.h>

#include <memory>
#include <string>

namespace glint {
namespace {

struct FreeHeif {
  void operator()(heif_context* context) const { heif_context_free(context); }
  void operator()(heif_image_handle* handle) const { heif_image_handle_release(handle); }
  void operator()(heif_color_profile_nclx* nclx) const { heif_nclx_color_profile_free(nclx); }
};
template <class T>
using Owned = std::unique_ptr<T, FreeHeif>;

bool Failed(const heif_error& error) { return error.code != heif_error_Ok; }

constexpr std::size_t kMostMetadataBytes = 16u << 20;  // of a profile or an EXIF block

ColourProfile ColourOf(const heif_image_handle* handle) {
  const std::size_t size = heif_image_handle_get_raw_color_profile_size(handle);
  if (size > 0 && size < kMostMetadataBytes) {
    std::string icc(size, '\0');
    if (!Failed(heif_image_handle_get_raw_color_profile(handle, icc.data()))) {
      return ReadColourProfile(icc);
    }
  }
  heif_color_profile_nclx* named = nullptr;
  if (Failed(heif_image_handle_get_nclx_color_profile(handle, &named))) return {};
  const Owned<heif_color_profile_nclx> nclx(named);
  if (!nclx) return {};
  return ProfileOfCodePoints(nclx->color_primaries, nclx->transfer_characteristics);
}

// The block begins with the offset of the TIFF header from what follows it: 6 where "Exif\0\0"
// stands before it, or 0.
std::string ExifOf(const heif_image_handle* handle) {
  heif_item_id id = 0;
  if (heif_image_handle_get_list_of_metadata_block_IDs(handle, "Exif", &id, 1) != 1) return {};
  const std::size_t size = heif_image_handle_get_metadata_size(handle, id);
  constexpr std::size_t kOffset = 4;
  if (size <= kOffset || size > kMostMetadataBytes) return {};
  std::string block(size, '\0');
  if (Failed(heif_image_handle_get_metadata(handle, id, block.data()))) return {};
  std::size_t offset = 0;
  for (std::size_t i = 0; i < kOffset; ++i) {
    offset = offset << 8 | static_cast<unsigned char>(block[i]);
  }
  if (offset >= size - kOffset) return {};
  return block.substr(kOffset + offset);
}

}  // namespace

HeifFacts ReadHeifFacts(const std::filesystem::path& file) {
  const Owned<heif_context> context(heif_context_alloc());
  if (Failed(heif_context_read_from_file(context.get(), file.c_str(), nullptr))) return {};
  heif_image_handle* primary = nullptr;
  if (Failed(heif_context_get_primary_image_handle(context.get(), &primary))) return {};
  const Owned<heif_image_handle> handle(primary);
  return {ColourOf(handle.get()), ExifOf(handle.get())};
}

}  // namespace glint
