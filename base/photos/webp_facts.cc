#include "base/photos/webp_facts.h"

#include <webp/mux.h>

#include <memory>

#include "base/files/files.h"

namespace glint {
namespace {

constexpr std::size_t kMostWebpBytes = 512u << 20;

struct FreeMux {
  void operator()(WebPMux* mux) const { WebPMuxDelete(mux); }
};

std::string ChunkOf(const WebPMux* mux, const char* name) {
  WebPData chunk{nullptr, 0};
  if (WebPMuxGetChunk(mux, name, &chunk) != WEBP_MUX_OK) return {};
  return {reinterpret_cast<const char*>(chunk.bytes), chunk.size};
}

}  // namespace

WebpFacts ReadWebpFacts(const std::filesystem::path& file) {
  const std::string bytes = ReadTextFile(file, kMostWebpBytes);
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPMux, FreeMux> mux(WebPMuxCreate(&data, 0));
  if (!mux) return {};
  WebpFacts facts{ChunkOf(mux.get(), "ICCP"), ChunkOf(mux.get(), "EXIF")};
  constexpr std::string_view kJpegsHeader("Exif\0\0", 6);  // which some programs leave there
  if (facts.exif.starts_with(kJpegsHeader)) facts.exif.erase(0, kJpegsHeader.size());
  return facts;
}

}  // namespace glint
