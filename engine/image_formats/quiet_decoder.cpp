#include "engine/image_formats/quiet_decoder.hpp"

#include "engine/image_formats/decoder_complaints.hpp"
#include "engine/image_formats/image_fault.hpp"
#include "engine/image_formats/sample_rules.hpp"
#include "engine/image_formats/stderr_capture.hpp"

#include <limits>
#include <mutex>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

namespace touchtrial::engine {
namespace {

namespace logging = cv::utils::logging;

/// OpenCV passes on what libtiff says only while its own log is this detailed.
class DetailedLog {
 public:
  DetailedLog() : before_(logging::setLogLevel(logging::LOG_LEVEL_DEBUG)) {}
  ~DetailedLog() { logging::setLogLevel(before_); }
  DetailedLog(const DetailedLog&) = delete;
  DetailedLog& operator=(const DetailedLog&) = delete;

 private:
  logging::LogLevel before_;
};

cv::Mat decode(const Bytes& bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw ImageFault{"has more than 2 GiB of samples in the file", "crop or shrink it"};
  }
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  cv::Mat decoded;
  std::string printed;
  {
    StderrCapture capture;
    const DetailedLog log;
    try {
      decoded = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
      decoded.release();
    }
    printed = capture.take();
  }
  if (const auto damage = damage_in(printed)) {
    throw ImageFault{"is damaged (" + *damage + ")", "copy or export it again"};
  }
  if (decoded.empty()) throw_truncated_image();
  return decoded;
}

/// One pixel of 1 to 4 channels, in OpenCV's order: grey, grey alpha, BGR, BGRA.
template <typename Sample>
std::uint8_t grey_of(const Sample* pixel, int channels, Alpha alpha) {
  const bool has_alpha = channels % 2 == 0 && alpha == Alpha::straight;
  const std::uint32_t opacity = has_alpha ? to_8_bit(pixel[channels - 1]) : 255U;
  const auto visible = [&](int channel) { return over_black(to_8_bit(pixel[channel]), opacity); };
  if (channels <= 2) return static_cast<std::uint8_t>(visible(0));
  return luma(visible(2), visible(1), visible(0));
}

template <typename Sample>
GreyImage grey_image(const cv::Mat& decoded, const DecoderInput& input) {
  GreyImage image(decoded.rows, decoded.cols);
  const int channels = decoded.channels();
  for (int y = 0; y < decoded.rows; ++y) {
    const Sample* pixel = decoded.ptr<Sample>(y);
    for (std::uint8_t& grey : image.row(y)) {
      const bool is_transparent = channels == 1 && input.transparent_grey == int{*pixel};
      grey = is_transparent ? std::uint8_t{0} : grey_of(pixel, channels, input.alpha);
      pixel += channels;
    }
  }
  return image;
}

/// White-is-zero is undone before alpha is composited: it concerns the colour only.
template <typename Sample>
void invert_grey(cv::Mat& decoded) {
  for (int y = 0; y < decoded.rows; ++y) {
    Sample* sample = decoded.ptr<Sample>(y);
    for (int x = 0; x < decoded.cols; ++x, sample += decoded.channels()) {
      *sample = static_cast<Sample>(~*sample);
    }
  }
}

template <typename Sample>
GreyImage convert(cv::Mat decoded, const DecoderInput& input) {
  if (input.alpha_as_columns) decoded = decoded.reshape(2);
  if (decoded.cols != input.width_px || decoded.rows != input.height_px) throw_truncated_image();
  if (input.white_is_zero) invert_grey<Sample>(decoded);
  return grey_image<Sample>(decoded, input);
}

}  // namespace

GreyImage decode_grey(const DecoderInput& input) {
  const cv::Mat decoded = decode(input.bytes);
  if (decoded.depth() == CV_8U) return convert<std::uint8_t>(decoded, input);
  if (decoded.depth() == CV_16U) return convert<std::uint16_t>(decoded, input);
  throw_unsupported_image("has samples that are neither 8 nor 16 bits wide");
}

}  // namespace touchtrial::engine
