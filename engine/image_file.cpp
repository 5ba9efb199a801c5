#include "engine/image_file.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "engine/image_formats/image_format.hpp"
#include "engine/pictures/colour_image.hpp"

#include <bit>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

namespace touchtrial::engine {
namespace {

/// Up to this size a file is read as a whole, which turns a failing disk into an error. A larger
/// file is mapped: if it is no picture, or contains only a small one, only the few pages that are
/// checked are read.
constexpr std::uintmax_t kLargestReadWhole = std::uintmax_t{1} << 26U;

GreyImage read_kind(ByteView file, GreyScale& scale, ImageNotes& notes) {
  switch (kind_of_image(file)) {
    case ImageKind::png:
      return read_png(file, scale);
    case ImageKind::jpeg:
      return read_jpeg(file, scale, notes);
    case ImageKind::tiff:
      return read_tiff(file, scale, notes);
    case ImageKind::bmp:
      return read_bmp(file, scale);
    case ImageKind::gif:
      return read_gif(file, scale, notes);
    case ImageKind::pnm:
      return read_pnm(file, scale);
  }
  throw std::logic_error("an image kind without a reader");
}

/// Refuses 16-bit samples that leave most of their range empty: nobody notices how few grey levels
/// are left. A picture alone does not tell how many bits its camera has.
void check_range(const GreyScale& scale) {
  const std::uint32_t max = scale.max_wide();
  const int used = std::bit_width(max);
  const std::string sample = "a sample of " + std::to_string(max);
  if (scale.bits() != 0 && used > scale.bits()) {
    throw ImageFault{"has " + sample + ", which takes " + std::to_string(used) + " bits",
                     "give --bits " + std::to_string(used) + " or more"};
  }
  if (scale.bits() != 0 || max == 0 || max >= kMinMaxWideSample) return;
  throw ImageFault{
      "uses only " + std::to_string(used) + " of its 16 bits (its largest sample is " +
          std::to_string(max) + "), of which " +
          std::to_string(to_8_bit(static_cast<std::uint16_t>(max)) + 1) +
          " grey levels would be left",
      "give --bits with the bits of its camera or scanner, for instance 12, or 16 if it is just "
      "dark; for a study, to `touchtrial stimuli import`"};
}

Picture decode_file(ByteView file, const SampleScale& samples) {
  if (file.empty()) throw ImageFault{"is empty", "copy or export it again"};
  Picture picture;
  GreyScale scale(samples);
  ImageNotes found;
  picture.grey = read_kind(file, scale, found);
  check_range(scale);
  picture.notes = notes_of_image(file);
  picture.notes.pictures = found.pictures;
  picture.notes.heights = found.heights;
  picture.notes.has_given_heights = found.has_given_heights;
  picture.notes.cut_share = found.cut_share;
  picture.notes.lacks_end = found.lacks_end;
  picture.notes.transparent_share =
      static_cast<double>(scale.transparent_pixels()) / static_cast<double>(picture.grey.size());
  return picture;
}

FileError error_about(const std::string& name, const std::string& what, const std::string& remedy) {
  return FileError(one_line(name + ": " + what + "; " + remedy));
}

}  // namespace

Picture read_picture(const std::filesystem::path& path, const SampleScale& scale) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kLargestReadWhole) {
    const MappedFile file(path);
    return decode_picture(file.bytes(), path.string(), scale);
  }
  return decode_picture(read_file(path), path.string(), scale);
}

GreyImage read_grey_image(const std::filesystem::path& path) {
  return read_picture(path).grey;
}

bool begins_like_image(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    const ImageKind kind = kind_of_image(MappedFile(path).bytes());
    return kind != ImageKind::bmp && kind != ImageKind::pnm;
  } catch (const ImageFault&) {
    return false;
  } catch (const FileError&) {
    return false;
  }
}

std::pair<int, int> size_of_image(const std::filesystem::path& path) {
  try {
    const MappedFile file(path);
    if (kind_of_image(file.bytes()) == ImageKind::png) return size_of_png(file.bytes());
  } catch (const ImageFault&) {
    // Reading it says what is wrong.
  }
  const GreyImage image = read_grey_image(path);
  return {image.width(), image.height()};
}

Picture decode_picture(ByteView file, const std::string& name, const SampleScale& scale) {
  try {
    return decode_file(file, scale);
  } catch (const ImageFault& fault) {
    throw error_about(name, fault.what, fault.remedy);
  } catch (const std::bad_alloc&) {
    throw error_about(name, "does not fit into memory", "crop or shrink it");
  } catch (const std::length_error&) {
    throw error_about(name, "does not fit into memory", "crop or shrink it");
  }
}

void write_png(const std::filesystem::path& path, const GreyImage& image) {
  if (image.empty()) throw std::invalid_argument("write_png: the image has no pixels");
  Bytes bytes;
  try {
    bytes = png_bytes(image);
  } catch (const FileError&) {
    throw error_about(path.string(), "cannot be encoded as PNG", "give a smaller image");
  }
  write_output(path, bytes);
}

}  // namespace touchtrial::engine
