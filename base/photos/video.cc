#include "base/photos/video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "base/errors/errors.h"
#include "base/images/image_bounds.h"
#include "base/photos/upright.h"

namespace glint {
namespace {

constexpr size_t kMostFrames = 10'000'000;

struct CloseFormat {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};
struct FreeCodec {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreeScaler {
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};

std::string Reason(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {0};
  av_strerror(code, text, sizeof(text));
  return text;
}

// What cameras write. Playlists and scripts (HLS, ffconcat) are none: they name other files to
// read.
constexpr char kContainers[] =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpegts,mpeg,asf,flv,mxf,h264,hevc";

// An opened file and its first video stream.
class Video {
 public:
  explicit Video(const std::filesystem::path& file) : file_(file) {
    av_log_set_level(AV_LOG_FATAL);
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
      throw UserError(file, "", "no such file", "check the path");
    }
    AVFormatContext* context = nullptr;
    AVDictionary* options = nullptr;
    av_dict_set(&options, "format_whitelist", kContainers, 0);
    av_dict_set(&options, "protocol_whitelist", "file", 0);
    const int code = avformat_open_input(&context, file.c_str(), nullptr, &options);
    av_dict_free(&options);
    if (code < 0) {
      throw UserError(file, "",
                      "no video that can be read (" + Reason(code) +
                          "), perhaps because it was copied only in part",
                      "copy it again, or remove it");
    }
    context_.reset(context);
    const bool described = avformat_find_stream_info(context, nullptr) >= 0;
    stream_ = av_find_best_stream(context, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (!described || stream_ < 0) {
      throw UserError(file, "", "a file without a video stream", "remove it");
    }
    CheckStream();
  }

  AVFormatContext* context() const { return context_.get(); }
  AVStream* stream() const { return context_->streams[stream_]; }
  const AVCodecParameters& codec() const { return *stream()->codecpar; }
  const std::filesystem::path& file() const { return file_; }

  // The next packet of the stream; false at the end, and where the file ends too early.
  bool Read(AVPacket* packet) const {
    while (true) {
      av_packet_unref(packet);
      if (av_read_frame(context_.get(), packet) < 0) return false;
      if ((packet->flags & AV_PKT_FLAG_CORRUPT) != 0) return false;
      if (packet->stream_index == stream_) return true;
    }
  }

  // EXIF orientation of the display matrix: a phone held upright writes a turned video.
  int Orientation() const {
    const auto* matrix = reinterpret_cast<const std::int32_t*>(DisplayMatrix());
    if (matrix == nullptr) return 1;
    const double anticlockwise_deg = av_display_rotation_get(matrix);
    if (!std::isfinite(anticlockwise_deg)) return 1;
    const int turns = static_cast<int>(std::lround(-anticlockwise_deg / 90)) & 3;
    constexpr int kExif[] = {1, 6, 3, 8};
    return kExif[turns];
  }

 private:
  // null: none.
  const std::uint8_t* DisplayMatrix() const {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 29, 100)  // FFmpeg 6.1
    const AVCodecParameters* parameters = stream()->codecpar;
    const AVPacketSideData* data = av_packet_side_data_get(
        parameters->coded_side_data, parameters->nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX);
    return data == nullptr ? nullptr : data->data;
#else
    return av_stream_get_side_data(stream(), AV_PKT_DATA_DISPLAYMATRIX, nullptr);
#endif
  }

  void CheckStream() const {
    const AVCodecParameters& codec = this->codec();
    if (codec.width < 16 || codec.height < 16 ||
        static_cast<size_t>(codec.width) * static_cast<size_t>(codec.height) > kMaxPixels) {
      throw UserError(file_, "size",
                      std::to_string(codec.width) + "x" + std::to_string(codec.height) + " pixels",
                      "use a video whose frames have at least 16 pixels per side and are not "
                      "larger than Glint reads");
    }
    if (codec.color_trc != AVCOL_TRC_SMPTE2084 && codec.color_trc != AVCOL_TRC_ARIB_STD_B67) return;
    throw UserError(file_, "", "an HDR video, whose tone curve depends on its scene",
                    "switch HDR off in the camera and film again, or convert it to an SDR video");
  }

  std::filesystem::path file_;
  std::unique_ptr<AVFormatContext, CloseFormat> context_;
  int stream_ = -1;
};

std::int64_t TimeOf(const AVPacket& packet) {
  return packet.pts != AV_NOPTS_VALUE ? packet.pts : packet.dts;
}

// Time stamps of all complete frames, in the order of showing. `packets` counts those that are
// there for decoding alone, too.
std::vector<std::int64_t> FrameTimes(const Video& video, size_t* packets = nullptr) {
  std::vector<std::int64_t> times;
  size_t count = 0;
  const std::unique_ptr<AVPacket, FreePacket> packet(av_packet_alloc());
  while (count < kMostFrames && video.Read(packet.get())) {
    ++count;
    if ((packet->flags & AV_PKT_FLAG_DISCARD) == 0) times.push_back(TimeOf(*packet));
  }
  std::sort(times.begin(), times.end());
  if (packets != nullptr) *packets = count;
  if (times.empty()) {
    throw UserError(video.file(), "", "a video that ends before its first frame",
                    "copy it again, or remove it");
  }
  return times;
}

std::unique_ptr<AVCodecContext, FreeCodec> OpenDecoder(const Video& video) {
  const AVCodec* decoder = avcodec_find_decoder(video.codec().codec_id);
  if (decoder == nullptr) {
    throw EnvironmentError(
        video.file().string() + ": found a video of the codec '" +
        avcodec_get_name(video.codec().codec_id) +
        "', for which no decoder is installed; install a libavcodec59 that includes it, or "
        "convert the video to H.264");
  }
  std::unique_ptr<AVCodecContext, FreeCodec> context(avcodec_alloc_context3(decoder));
  avcodec_parameters_to_context(context.get(), &video.codec());
  context->thread_count = 1;  // photographs are what is shared out
  context->pkt_timebase = video.stream()->time_base;
  if (const int code = avcodec_open2(context.get(), decoder, nullptr); code < 0) {
    throw UserError(video.file(), "", "a video that cannot be decoded (" + Reason(code) + ")",
                    "convert it to H.264");
  }
  return context;
}

// Decodes until the frame of that time comes out; null: it never does.
std::unique_ptr<AVFrame, FreeFrame> DecodeUntil(const Video& video, AVCodecContext* decoder,
                                                std::int64_t time) {
  const std::unique_ptr<AVPacket, FreePacket> packet(av_packet_alloc());
  std::unique_ptr<AVFrame, FreeFrame> frame(av_frame_alloc());
  bool more = true;
  while (true) {
    const int code = avcodec_receive_frame(decoder, frame.get());
    if (code >= 0) {
      const std::int64_t at = frame->pts != AV_NOPTS_VALUE ? frame->pts : frame->pkt_dts;
      if (at != time) continue;
      const bool damaged =
          (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame->decode_error_flags != 0;
      return damaged ? nullptr : std::move(frame);
    }
    if (code != AVERROR(EAGAIN) || !more) return nullptr;
    more = video.Read(packet.get());
    avcodec_send_packet(decoder, more ? packet.get() : nullptr);  // damage shows as a missing frame
  }
}

std::unique_ptr<AVFrame, FreeFrame> Decode(const Video& video, std::int64_t time,
                                           std::int64_t first) {
  // Some containers find no key frame; then from the start.
  for (const std::int64_t from : {time, first}) {
    const int stream = video.stream()->index;
    if (avformat_seek_file(video.context(), stream, INT64_MIN, from, from, 0) < 0) continue;
    const auto decoder = OpenDecoder(video);
    if (auto frame = DecodeUntil(video, decoder.get(), time)) return frame;
  }
  return nullptr;
}

// What the stream leaves open is decided by size, as players do.
int MatrixOf(const AVFrame& frame) {
  switch (frame.colorspace) {
    case AVCOL_SPC_BT709:
      return SWS_CS_ITU709;
    case AVCOL_SPC_BT2020_NCL:
    case AVCOL_SPC_BT2020_CL:
      return SWS_CS_BT2020;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
      return SWS_CS_ITU601;
    default:
      return std::min(frame.width, frame.height) >= 720 ? SWS_CS_ITU709 : SWS_CS_ITU601;
  }
}

bool IsFullRange(const AVFrame& frame) {
  const std::string format = av_get_pix_fmt_name(static_cast<AVPixelFormat>(frame.format));
  return frame.color_range == AVCOL_RANGE_JPEG || format.rfind("yuvj", 0) == 0;
}

// Interleaved 8-bit R, G, B.
std::vector<std::uint8_t> RgbOf(const Video& video, const AVFrame& frame) {
  const std::unique_ptr<SwsContext, FreeScaler> scaler(sws_getContext(
      frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
      frame.height, AV_PIX_FMT_RGB24, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr,
      nullptr, nullptr));
  if (!scaler) {
    throw UserError(video.file(), "", "a video whose pixel format cannot be converted",
                    "convert it to H.264");
  }
  sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(MatrixOf(frame)), IsFullRange(frame),
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, 1 << 16, 1 << 16);
  // Rows a little apart: the vector code writes beyond the last pixel.
  const size_t row = 3 * static_cast<size_t>(frame.width), padded = (row + 63) / 64 * 64 + 64;
  std::vector<std::uint8_t> rows(padded * static_cast<size_t>(frame.height));
  std::uint8_t* const planes[4] = {rows.data(), nullptr, nullptr, nullptr};
  const int strides[4] = {static_cast<int>(padded), 0, 0, 0};
  sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, planes, strides);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(row * static_cast<size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y) {
    const auto start = rows.begin() + static_cast<std::ptrdiff_t>(padded * y);
    rgb.insert(rgb.end(), start, start + static_cast<std::ptrdiff_t>(row));
  }
  return rgb;
}

std::string CameraModel(const Video& video) {
  std::string model;
  for (const char* key : {"com.apple.quicktime.make", "com.apple.quicktime.model"}) {
    const AVDictionaryEntry* entry = av_dict_get(video.context()->metadata, key, nullptr, 0);
    if (entry != nullptr) model += (model.empty() ? "" : " ") + std::string(entry->value);
  }
  return model;
}

std::pair<int, int> UprightSize(const Video& video) {
  const int width = video.codec().width, height = video.codec().height;
  return TurnExchangesAxes(video.Orientation()) ? std::pair{height, width}
                                                : std::pair{width, height};
}

}  // namespace

VideoInfo ReadVideoInfo(const std::filesystem::path& file) {
  const Video video(file);
  VideoInfo info;
  size_t packets = 0;
  info.frames = static_cast<int>(FrameTimes(video, &packets).size());
  const std::int64_t missing = video.stream()->nb_frames - static_cast<std::int64_t>(packets);
  info.missing = static_cast<int>(std::clamp<std::int64_t>(missing, 0, kMostFrames));
  std::tie(info.width, info.height) = UprightSize(video);
  return info;
}

Photo ReadVideoFrame(const std::filesystem::path& file, int frame) {
  const Video video(file);
  const std::vector<std::int64_t> times = FrameTimes(video);
  if (frame < 0 || static_cast<size_t>(frame) >= times.size()) {
    throw UserError(file, "frame",
                    std::to_string(frame) + " of a video of " + std::to_string(times.size()) +
                        " complete frames",
                    "copy the video again, or name another frame");
  }
  const auto picture = Decode(video, times[static_cast<size_t>(frame)], times[0]);
  if (!picture || picture->width != video.codec().width ||
      picture->height != video.codec().height) {
    throw UserError(file, "frame " + std::to_string(frame), "a frame that cannot be decoded",
                    "copy the video again, or remove the frame");
  }
  Photo photo;
  photo.format = "video";
  photo.camera_model = CameraModel(video);
  photo.orientation = video.Orientation();
  photo.image =
      UprightImage(RgbOf(video, *picture), {picture->width, picture->height, 3}, photo.orientation);
  return photo;
}

std::pair<int, int> VideoFrameSize(const std::filesystem::path& file) {
  return UprightSize(Video(file));
}

}  // namespace glint
