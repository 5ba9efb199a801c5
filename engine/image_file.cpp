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

/// Up to this size a file is read as a whole, which turns a failing disk into an error. A larger
/// file is mapped: if it is no picture, or contains only a small one, only the few pages that are
/// checked are read.
constexpr std::uintmax_t kLargestReadWhole = std::uintmax_t{1} << 26U;

GreyImage decode_file(ByteView file) {
  if (file.empty()) throw ImageFault{"is empty", "copy or export it again"};
  switch (kind_of_image(file)) {
    case ImageKind::png:
      return read_png(file);
    case ImageKind::jpeg:
      return read_jpeg(file);
    case ImageKind::tiff:
      return read_tiff(file);
    case ImageKind::bmp:
      return read_bmp(file);
    case ImageKind::pnm:
      return read_pnm(file);
  }
  throw std::logic_error("an image kind without a reader");
}

FileError error_about(const std::string& name, const std::string& what, const std::string& remedy) {
  return FileError(one_line(name + ": " + what + "; " + remedy));
}

}  // namespace

GreyImage read_grey_image(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kLargestReadWhole) {
    const MappedFile file(path);
    return decode_grey_image(file.bytes(), path.string());
  }
  return decode_grey_image(read_file(path), path.string());
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

GreyImage decode_grey_image(ByteView file, const std::string& name) {
  try {
    return decode_file(file);
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
