// GIF, by stb_image.
#include "engine/image_file.hpp"
#include "engine/image_formats/image_format.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include <stb_image.h>

namespace touchtrial::engine {
namespace {

/// A file in memory that stb_image reads byte by byte. After the end of the file it returns zeros;
/// the attempt is recorded.
struct ByteStream {
  ByteView left;
  bool ended = false;
};

int stream_bytes(void* user, char* to, int count) {
  auto& stream = *static_cast<ByteStream*>(user);
  const std::size_t taken = std::min(stream.left.size(), static_cast<std::size_t>(count));
  // It requests more than it needs, but only when it needs data.
  if (taken == 0) stream.ended = true;
  std::memcpy(to, stream.left.data(), taken);
  stream.left = stream.left.subspan(taken);
  return static_cast<int>(taken);
}

void skip_stream(void* user, int count) {
  auto& stream = *static_cast<ByteStream*>(user);
  const auto skipped = static_cast<std::size_t>(std::max(count, 0));
  if (count < 0 || skipped > stream.left.size()) stream.ended = true;
  stream.left = stream.left.subspan(std::min(skipped, stream.left.size()));
}

int stream_ended(void* user) {
  return static_cast<ByteStream*>(user)->left.empty() ? 1 : 0;
}

constexpr stbi_io_callbacks kReading = {stream_bytes, skip_stream, stream_ended};

void free_pixels(stbi_uc* pixels) {
  stbi_image_free(pixels);
}

GreyImage read_with_stb(ByteView file, GreyScale& scale) {
  constexpr int kChannels = 4;
  ByteStream stream{file};
  int width = 0;
  int height = 0;
  int stored_channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&free_pixels)> pixels(
      stbi_load_from_callbacks(&kReading, &stream, &width, &height, &stored_channels, kChannels),
      free_pixels);
  if (stream.ended) throw_truncated_image();
  if (!pixels) {
    const std::string complaint = stbi_failure_reason();
    if (complaint == "outofmem") throw std::bad_alloc();
    throw_unsupported_image("cannot be decoded (" + complaint + ")");
  }
  GreyImage image(height, width);
  for (int y = 0; y < height; ++y) {
    const std::size_t at = image.row(0).size() * static_cast<std::size_t>(y) * kChannels;
    scale.make_grey(pixels.get() + at, kChannels, Alpha::straight, image.row(y));
  }
  return image;
}

/// Iterates over the blocks of a GIF. Source: GIF89a.
class GifBlocks {
 public:
  explicit GifBlocks(ByteView file) : file_(file) {
    constexpr std::size_t kPaletteFlagsAt = 10;
    at_ = 13 + palette_bytes(kPaletteFlagsAt);
    while (step()) {
    }
  }

  [[nodiscard]] int pictures() const noexcept { return pictures_; }
  [[nodiscard]] std::uint64_t packed_bytes() const noexcept { return packed_bytes_; }
  [[nodiscard]] bool lacks_end() const noexcept { return lacks_end_; }

 private:
  enum Block : std::uint8_t { kExtension = 0x21, kPicture = 0x2C, kEnd = 0x3B };

  [[nodiscard]] std::size_t byte(std::size_t at) const { return bytes_at(file_, at, 1)[0]; }

  [[nodiscard]] std::size_t palette_bytes(std::size_t flags_at) const {
    const std::size_t flags = byte(flags_at);
    return (flags & 0x80U) == 0 ? 0 : std::size_t{3} << ((flags & 7U) + 1);
  }

  /// \return false after the end
  bool step() {
    if (at_ == file_.size() && pictures_ > 0) {
      lacks_end_ = true;
      return false;
    }
    switch (byte(at_)) {
      case kEnd:
        return false;
      case kExtension:
        skip_data(at_ + 2);
        return true;
      case kPicture: {
        constexpr std::size_t kSize = 10;
        const std::uint64_t before = data_bytes_;
        skip_data(at_ + kSize + palette_bytes(at_ + kSize - 1) + 1);
        if (pictures_++ == 0) packed_bytes_ = data_bytes_ - before;
        return true;
      }
      default:
        throw_truncated_image();
    }
  }

  /// Blocks of data, each after its size, up to an empty one.
  void skip_data(std::size_t at) {
    for (; byte(at) != 0; at += byte(at) + 1) data_bytes_ += byte(at);
    at_ = at + 1;
  }

  ByteView file_;
  std::size_t at_ = 0;
  int pictures_ = 0;
  bool lacks_end_ = false;
  std::uint64_t packed_bytes_ = 0;  ///< of the first picture
  std::uint64_t data_bytes_ = 0;
};

}  // namespace

GreyImage read_gif(ByteView file, GreyScale& scale, ImageNotes& notes) {
  const GifBlocks blocks(file);
  notes.pictures = blocks.pictures();
  notes.lacks_end = blocks.lacks_end();
  const std::uint64_t width = little16(file, 6);
  const std::uint64_t height = little16(file, 8);
  check_image_size(static_cast<std::int64_t>(width), static_cast<std::int64_t>(height));
  // A code of at most 12 bits stands for at most 4096 pixels.
  constexpr std::uint64_t kMaxPixelsOfByte = 2731;
  if (width * height > blocks.packed_bytes() * kMaxPixelsOfByte) throw_truncated_image();
  return read_with_stb(file, scale);
}

}  // namespace touchtrial::engine
