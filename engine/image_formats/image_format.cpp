#include "engine/image_formats/image_format.hpp"

#include "engine/image_file.hpp"

#include <array>
#include <string_view>

namespace touchtrial::engine {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view start;
  ImageKind kind;
};
constexpr std::array kSignatures = {Signature{"\x89PNG\r\n\x1a\n"sv, ImageKind::png},
                                    Signature{"\xff\xd8\xff"sv, ImageKind::jpeg},
                                    Signature{"II*\0"sv, ImageKind::tiff},
                                    Signature{"MM\0*"sv, ImageKind::tiff},
                                    Signature{"BM"sv, ImageKind::bmp},
                                    Signature{"GIF8"sv, ImageKind::gif},
                                    Signature{"P2"sv, ImageKind::pnm},
                                    Signature{"P3"sv, ImageKind::pnm},
                                    Signature{"P5"sv, ImageKind::pnm},
                                    Signature{"P6"sv, ImageKind::pnm}};

struct ForeignSignature {
  std::size_t offset;
  std::string_view text;
  std::string_view name;
};
constexpr std::array kForeignSignatures = {ForeignSignature{8, "WEBP"sv, "WebP"},
                                           ForeignSignature{4, "ftyp"sv, "HEIF, AVIF or video"},
                                           ForeignSignature{4, "jP  "sv, "JPEG 2000"},
                                           ForeignSignature{0, "\xff\x4f\xff\x51"sv, "JPEG 2000"},
                                           ForeignSignature{0, "II+\0"sv, "BigTIFF"},
                                           ForeignSignature{0, "MM\0+"sv, "BigTIFF"},
                                           ForeignSignature{0, "8BPS"sv, "Photoshop"},
                                           ForeignSignature{0, "\x76\x2f\x31\x01"sv, "OpenEXR"},
                                           ForeignSignature{0, "%PDF"sv, "PDF"},
                                           ForeignSignature{0, "P1"sv, "PBM"},
                                           ForeignSignature{0, "P4"sv, "PBM"},
                                           ForeignSignature{0, "P7"sv, "PAM"}};

bool has_text_at(std::string_view file, std::size_t offset, std::string_view text) {
  return file.size() >= offset && file.substr(offset).starts_with(text);
}

}  // namespace

ImageKind kind_of_image(ByteView file) {
  const std::string_view start(reinterpret_cast<const char*>(file.data()),
                               file.size() < 16 ? file.size() : 16);
  for (const Signature& signature : kSignatures) {
    if (start.starts_with(signature.start)) return signature.kind;
  }
  for (const ForeignSignature& signature : kForeignSignatures) {
    if (!has_text_at(start, signature.offset, signature.text)) continue;
    throw ImageFault{"is a " + std::string(signature.name) + " file, a kind that is not supported",
                     "save it as PNG, JPEG, TIFF, BMP, GIF or PGM"};
  }
  throw ImageFault{"is not an image of a known kind",
                   "give a PNG, JPEG, TIFF, BMP, GIF or PGM file [not-a-picture]"};
}

void throw_truncated_image() {
  throw ImageFault{"is truncated or damaged", "copy or export it again [truncated-picture]"};
}

void throw_damaged_image(const std::string& message) {
  if (message.empty()) throw_truncated_image();
  throw ImageFault{"is damaged (" + message + ")", "copy or export it again [damaged-picture]"};
}

void throw_unsupported_image(const std::string& what) {
  throw ImageFault{what, "save it as 8- or 16-bit grey or RGB, for instance as PNG"};
}

void check_image_size(std::int64_t width_px, std::int64_t height_px) {
  const std::string size = std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels";
  if (width_px <= 0 || height_px <= 0) {
    throw ImageFault{"has " + size, "export it again with at least one pixel"};
  }
  if (width_px > kMaxImagePixels / height_px) {
    throw ImageFault{
        "has " + size + ", more than " + std::to_string(kMaxImagePixels) + " pixels in total",
        "crop or shrink it"};
  }
  if (width_px > kMaxSidePx || height_px > kMaxSidePx) {
    throw ImageFault{"has " + size + ", a side longer than " + std::to_string(kMaxSidePx),
                     "crop or shrink it"};
  }
}

ByteView bytes_at(ByteView bytes, std::size_t offset, std::size_t count) {
  if (offset > bytes.size() || count > bytes.size() - offset) throw_truncated_image();
  return bytes.subspan(offset, count);
}

std::uint32_t number_at(ByteView bytes, std::size_t offset, std::size_t size, ByteOrder order) {
  const ByteView digits = bytes_at(bytes, offset, size);
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i) {
    number = number << 8U | digits[order == ByteOrder::big ? i : size - 1 - i];
  }
  return number;
}

}  // namespace touchtrial::engine
