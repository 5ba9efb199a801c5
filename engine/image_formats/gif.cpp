// Reads GIF files with stb_image.
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
  ByteView remaining;
  bool read_past_end = false;
};

int read_stream(void* user, char* buffer, int count) {
  auto& stream = *static_cast<ByteStream*>(user);
  const std::size_t size = std::min(stream.remaining.size(), static_cast<std::size_t>(count));
  // stb_image requests more bytes than it needs, but only when it needs some.
  if (size == 0) stream.read_past_end = true;
  std::memcpy(buffer, stream.remaining.data(), size);
  stream.remaining = stream.remaining.subspan(size);
  return static_cast<int>(size);
}

void skip_stream(void* user, int count) {
  auto& stream = *static_cast<ByteStream*>(user);
  const auto skip_size = static_cast<std::size_t>(std::max(count, 0));
  if (count < 0 || skip_size > stream.remaining.size()) stream.read_past_end = true;
  stream.remaining = stream.remaining.subspan(std::min(skip_size, stream.remaining.size()));
}

int is_stream_end(void* user) {
  return static_cast<ByteStream*>(user)->remaining.empty() ? 1 : 0;
}

constexpr stbi_io_callbacks kStreamCallbacks = {read_stream, skip_stream, is_stream_end};

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
      stbi_load_from_callbacks(&kStreamCallbacks, &stream, &width, &height, &stored_channels,
                               kChannels),
      free_pixels);
  if (stream.read_past_end) throw_truncated_image();
  if (!pixels) {
    const std::string message = stbi_failure_reason();
    if (message == "outofmem") throw std::bad_alloc();
    throw_unsupported_image("cannot be decoded (" + message + ")");
  }
  GreyImage image(height, width);
  for (int y = 0; y < height; ++y) {
    const std::size_t offset = image.row(0).size() * static_cast<std::size_t>(y) * kChannels;
    scale.make_grey(pixels.get() + offset, kChannels, Alpha::straight, image.row(y));
  }
  return image;
}

/// Iterates over the blocks of a GIF. Source: GIF89a.
class GifBlocks {
 public:
  explicit GifBlocks(ByteView file) : file_(file) {
    constexpr std::size_t kPaletteFlagsOffset = 10;
    offset_ = 13 + palette_bytes(kPaletteFlagsOffset);
    while (step()) {
    }
  }

  [[nodiscard]] int pictures() const noexcept { return pictures_; }
  [[nodiscard]] std::uint64_t packed_bytes() const noexcept { return packed_bytes_; }
  [[nodiscard]] bool lacks_end() const noexcept { return lacks_end_; }

 private:
  enum Block : std::uint8_t { kExtension = 0x21, kPicture = 0x2C, kEnd = 0x3B };

  [[nodiscard]] std::size_t byte(std::size_t offset) const { return bytes_at(file_, offset, 1)[0]; }

  [[nodiscard]] std::size_t palette_bytes(std::size_t flags_offset) const {
    const std::size_t flags = byte(flags_offset);
    return (flags & 0x80U) == 0 ? 0 : std::size_t{3} << ((flags & 7U) + 1);
  }

  /// \return false after the end
  bool step() {
    if (offset_ == file_.size() && pictures_ > 0) {
      lacks_end_ = true;
      return false;
    }
    switch (byte(offset_)) {
      case kEnd:
        return false;
      case kExtension:
        skip_data(offset_ + 2);
        return true;
      case kPicture: {
        constexpr std::size_t kSize = 10;
        const std::uint64_t bytes_before = data_bytes_;
        skip_data(offset_ + kSize + palette_bytes(offset_ + kSize - 1) + 1);
        if (pictures_++ == 0) packed_bytes_ = data_bytes_ - bytes_before;
        return true;
      }
      default:
        throw_truncated_image();
    }
  }

  /// Skips blocks of data, each preceded by its size, up to an empty one.
  void skip_data(std::size_t offset) {
    for (; byte(offset) != 0; offset += byte(offset) + 1) data_bytes_ += byte(offset);
    offset_ = offset + 1;
  }

  ByteView file_;
  std::size_t offset_ = 0;
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
