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

/// Up to this size a file is read into memory, so that a disk fault raises an error. A larger file
/// is mapped, so that few pages are read if it contains no picture or a small one.
constexpr std::uintmax_t kMaxReadBytes = std::uintmax_t{1} << 26U;

GreyImage decode_by_kind(ByteView file, GreyScale& scale, ImageNotes& notes) {
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

/// Refuses 16-bit samples that use little of their range, because the loss of grey levels would go
/// unnoticed. A picture does not state its camera's number of bits.
void check_range(const GreyScale& scale) {
  const WideSamples& samples = scale.wide_samples();
  const int used_bits = samples.bits();
  const std::string bits = std::to_string(used_bits);
  if (scale.bits() != 0 && used_bits > scale.bits()) {
    throw ImageFault{"has samples of " + bits + " bits, more than --bits",
                     "give --bits " + bits + ", or save this one as 8 bit if others have fewer"};
  }
  const std::uint32_t limit = 1U << static_cast<unsigned>(used_bits);
  if (scale.bits() != 0 || used_bits == 0 || limit > kMinMaxWideSample) return;
  const std::uint64_t samples_above = samples.count_above(used_bits);
  throw ImageFault{
      "uses only " + bits + " of its 16 bits (" +
          (samples_above == 0 ? "no sample is"
                              : "only " + std::to_string(samples_above) + " samples are") +
          " above " + std::to_string(limit - 1) + "), which would leave " +
          std::to_string(to_8_bit(static_cast<std::uint16_t>(limit - 1)) + 1) + " grey levels",
      "give --bits with the bits of its camera or scanner, for instance 12, or 16 if it is only "
      "dark; for a study, to `touchtrial stimuli import` or `touchtrial new`"};
}

Picture decode_file(ByteView file, const SampleScale& sample_scale) {
  if (file.empty()) throw ImageFault{"is empty", "copy or export it again [empty-picture]"};
  const auto share = [](std::uint64_t part, std::uint64_t total) {
    return static_cast<double>(part) / static_cast<double>(total);
  };
  Picture picture;
  GreyScale scale(sample_scale);
  picture.grey = decode_by_kind(file, scale, picture.notes);
  check_range(scale);
  // The metadata are read after decoding, because a damaged picture may have unbounded metadata.
  const ImageNotes metadata = notes_of_image(file);
  picture.notes.orientation = metadata.orientation;
  picture.notes.pixels_per_mm = metadata.pixels_per_mm;
  picture.notes.camera_dpi = metadata.camera_dpi;
  picture.notes.has_one_bit = metadata.has_one_bit;
  const WideSamples& wide_samples = scale.wide_samples();
  if (sample_scale.bits != 0 && wide_samples.count() > 0) {
    picture.notes.cut_share =
        share(wide_samples.count_above(sample_scale.bits), wide_samples.count());
  }
  picture.notes.transparent_share = share(scale.transparent_pixels(), picture.grey.size());
  return picture;
}

FileError error_about(const std::string& name, const std::string& fault,
                      const std::string& remedy) {
  return FileError(one_line(name + ": " + fault + "; " + remedy));
}

/// Calls `decode` and converts its faults to FileError with the file's name.
template <typename Decode>
auto decode_with_file_errors(const std::string& name, const Decode& decode) {
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
  if (!error && size > kMaxReadBytes) {
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
    // Reading the picture below reports the fault.
  }
  const GreyImage image = read_grey_image(path);
  return {image.width(), image.height()};
}

Picture decode_picture(ByteView file, const std::string& name, const SampleScale& scale) {
  return decode_with_file_errors(name, [&] { return decode_file(file, scale); });
}

GreyImage opacity_of(ByteView file, const std::string& name) {
  return decode_with_file_errors(name, [&] {
    GreyScale scale{SampleScale{}};
    scale.show_opacity();
    ImageNotes unused;
    return decode_by_kind(file, scale, unused);
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
