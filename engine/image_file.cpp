#include "engine/image_file.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "engine/image_formats/image_format.hpp"
#include "engine/pictures/colour_image.hpp"

#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

namespace touchtrial::engine {
namespace {

/// Up to this size a file is read as a whole, so that a failing disk is an error. A larger file is
/// mapped: if it is not a picture, or contains only a small one, only a few pages are read.
constexpr std::uintmax_t kMaxReadWhole = std::uintmax_t{1} << 26U;

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

/// Refuses 16-bit samples that use little of their range, because few grey levels would remain
/// unnoticed. The camera's number of bits cannot be read from the picture.
void check_range(const GreyScale& scale) {
  const WideSamples& samples = scale.wide();
  const int used = samples.bits();
  const std::string bits = std::to_string(used);
  if (scale.bits() != 0 && used > scale.bits()) {
    throw ImageFault{"has samples of " + bits + " bits, more than --bits",
                     "give --bits " + bits + ", or save this one as 8 bit if others have fewer"};
  }
  const std::uint32_t limit = 1U << static_cast<unsigned>(used);
  if (scale.bits() != 0 || used == 0 || limit > kMinMaxWideSample) return;
  const std::uint64_t above = samples.above(used);
  throw ImageFault{
      "uses only " + bits + " of its 16 bits (" +
          (above == 0 ? "no sample is" : "but for " + std::to_string(above) + " samples, none is") +
          " above " + std::to_string(limit - 1) + "), of which " +
          std::to_string(to_8_bit(static_cast<std::uint16_t>(limit - 1)) + 1) +
          " grey levels would be left",
      "give --bits with the bits of its camera or scanner, for instance 12, or 16 if it is just "
      "dark; for a study, to `touchtrial stimuli import` or `touchtrial new`"};
}

Picture decode_file(ByteView file, const SampleScale& samples) {
  if (file.empty()) throw ImageFault{"is empty", "copy or export it again [empty-picture]"};
  const auto share = [](std::uint64_t part, std::uint64_t all) {
    return static_cast<double>(part) / static_cast<double>(all);
  };
  Picture picture;
  GreyScale scale(samples);
  picture.grey = read_kind(file, scale, picture.notes);
  check_range(scale);
  // Only of a readable picture, because the notes of a damaged one may be unbounded.
  const ImageNotes stated = notes_of_image(file);
  picture.notes.orientation = stated.orientation;
  picture.notes.pixels_per_mm = stated.pixels_per_mm;
  picture.notes.camera_dpi = stated.camera_dpi;
  picture.notes.has_one_bit = stated.has_one_bit;
  const WideSamples& wide = scale.wide();
  if (samples.bits != 0 && wide.count() > 0) {
    picture.notes.cut_share = share(wide.above(samples.bits), wide.count());
  }
  picture.notes.transparent_share = share(scale.transparent_pixels(), picture.grey.size());
  return picture;
}

FileError error_about(const std::string& name, const std::string& what, const std::string& remedy) {
  return FileError(one_line(name + ": " + what + "; " + remedy));
}

/// Calls `decode`, and adds the file's name to its faults.
template <typename Decode>
auto named(const std::string& name, const Decode& decode) {
  try {
    return decode();
  } catch (const ImageFault& fault) {
    throw error_about(name, fault.what, fault.remedy);
  } catch (const std::bad_alloc&) {
    throw error_about(name, "does not fit into memory", "crop or shrink it");
  } catch (const std::length_error&) {
    throw error_about(name, "does not fit into memory", "crop or shrink it");
  }
}

}  // namespace

Picture read_picture(const std::filesystem::path& path, const SampleScale& scale) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kMaxReadWhole) {
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
    // Reading it reports the fault.
  }
  const GreyImage image = read_grey_image(path);
  return {image.width(), image.height()};
}

Picture decode_picture(ByteView file, const std::string& name, const SampleScale& scale) {
  return named(name, [&] { return decode_file(file, scale); });
}

GreyImage opacity_of(ByteView file, const std::string& name) {
  return named(name, [&] {
    GreyScale scale{SampleScale{}};
    scale.show_opacity();
    ImageNotes unused;
    return read_kind(file, scale, unused);
  });
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
