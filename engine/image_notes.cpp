#include "engine/image_notes.hpp"

#include "core/units.hpp"
#include "engine/image_formats/image_format.hpp"
#include "engine/image_formats/tiff_directory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace touchtrial::engine {
namespace {

constexpr double kMmPerCm = 10.0;
constexpr double kMmPerMetre = 1000.0;

bool is_near(double pixels_per_mm, double dots_per_inch) {
  return std::abs(pixels_per_mm * kMmPerInch - dots_per_inch) < 0.1;
}

std::optional<double> plausible_resolution(double x, double y, double unit_mm) {
  const bool is_square = std::abs(x - y) <= 0.01 * std::max(x, y);
  // Pixel sizes below 1 um or above 100 mm are implausible.
  if (!is_square || !(x / unit_mm >= 0.01) || !(x / unit_mm <= 1000.0)) return std::nullopt;
  // Programs write these defaults for an unknown resolution.
  if (is_near(x / unit_mm, 72.0) || is_near(x / unit_mm, 96.0)) return std::nullopt;
  return x / unit_mm;
}

/// Whether Exif data contain an exposure, which only a camera writes.
bool has_exposure(ByteView file, const TiffDirectory& directory) {
  const std::uint32_t offset = directory.value(TiffTag::exif_directory, 0);
  if (offset == 0) return false;
  const TiffDirectory exif(file, offset);
  return std::ranges::any_of(
      std::array{TiffTag::exposure_time, TiffTag::f_number, TiffTag::sensitivity,
                 TiffTag::time_of_exposure, TiffTag::focal_length, TiffTag::lens_model},
      [&](TiffTag tag) { return exif.has(tag); });
}

/// The device that made a picture file, which determines the meaning of its resolution.
enum class Maker {
  unknown,
  camera_or_scanner,
  camera,
};

Maker maker_of(ByteView file, const TiffDirectory& directory) {
  if (has_exposure(file, directory)) return Maker::camera;
  const bool has_name = directory.has(TiffTag::make) || directory.has(TiffTag::model);
  return has_name ? Maker::camera_or_scanner : Maker::unknown;
}

/// A camera's resolution is unrelated to the object. Cameras and their software always write 180,
/// 240, 300 or 350; of these, scanners use only 300.
void classify_resolution(Maker maker, ImageNotes& notes) {
  if (!notes.pixels_per_mm) return;
  const auto is_dpi = [&](double dots) { return is_near(*notes.pixels_per_mm, dots); };
  const bool is_from_camera = maker == Maker::camera || is_dpi(180.0) || is_dpi(240.0) ||
                              is_dpi(350.0) || (maker == Maker::camera_or_scanner && is_dpi(300.0));
  if (!is_from_camera) return;
  notes.camera_dpi = *notes.pixels_per_mm * kMmPerInch;
  notes.pixels_per_mm.reset();
}

ImageNotes notes_of_tiff(ByteView file, Maker& maker) {
  const TiffDirectory directory(file, pictures_of_tiff(file).first);
  maker = maker_of(file, directory);
  ImageNotes notes;
  notes.orientation = static_cast<int>(directory.value(TiffTag::orientation, 1));
  notes.has_one_bit = directory.value(TiffTag::bits_per_sample, 0) == 1;
  const auto x = directory.fraction(TiffTag::x_resolution);
  const auto y = directory.fraction(TiffTag::y_resolution);
  constexpr std::uint32_t kInch = 2;
  constexpr std::uint32_t kCentimetre = 3;
  const std::uint32_t unit = directory.value(TiffTag::resolution_unit, kInch);
  if (x && y && unit == kInch) notes.pixels_per_mm = plausible_resolution(*x, *y, kMmPerInch);
  if (x && y && unit == kCentimetre) notes.pixels_per_mm = plausible_resolution(*x, *y, kMmPerCm);
  return notes;
}

/// Reads Exif metadata, a TIFF directory within another file.
void read_exif(ByteView exif, ImageNotes& notes, Maker& maker) {
  try {
    const ImageNotes exif_notes = notes_of_tiff(exif, maker);
    notes.orientation = exif_notes.orientation;
    notes.has_one_bit |= exif_notes.has_one_bit;
    if (exif_notes.pixels_per_mm) notes.pixels_per_mm = exif_notes.pixels_per_mm;
  } catch (const ImageFault&) {
    // Other parts of the file may still have valid metadata.
  }
}

bool starts_with(ByteView bytes, std::string_view text) {
  return text_of(bytes.first(std::min(bytes.size(), text.size()))) == text;
}

void read_jfif(ByteView data, ImageNotes& notes) {
  const double x = big16(data, 8);
  const double y = big16(data, 10);
  if (data[7] == 1) notes.pixels_per_mm = plausible_resolution(x, y, kMmPerInch);
  if (data[7] == 2) notes.pixels_per_mm = plausible_resolution(x, y, kMmPerCm);
}

/// Reads the segments before the first scan.
void read_jpeg_notes(ByteView file, ImageNotes& notes, Maker& maker) {
  using namespace std::string_view_literals;
  constexpr std::uint32_t kScan = 0xFFDA;
  for (std::size_t offset = 2; big16(file, offset) >= 0xFFC0 && big16(file, offset) != kScan;) {
    const ByteView data = bytes_at(file, offset + 4, std::max(big16(file, offset + 2), 2U) - 2);
    if (big16(file, offset) == 0xFFE0 && starts_with(data, "JFIF\0"sv)) read_jfif(data, notes);
    if (big16(file, offset) == 0xFFE1 && starts_with(data, "Exif\0\0"sv)) {
      read_exif(data.subspan(6), notes, maker);
    }
    offset += 4 + data.size();
  }
}

void read_png_notes(ByteView file, ImageNotes& notes, Maker& maker) {
  for (std::size_t offset = 8; offset < file.size();) {
    const ByteView data = bytes_at(file, offset + 8, big32(file, offset));
    const std::string type = text_of(bytes_at(file, offset + 4, 4));
    if (type == "IEND") return;
    if (type == "IHDR" && data.size() == 13) notes.has_one_bit = data[8] == 1;
    if (type == "pHYs" && data.size() == 9 && data[8] == 1) {
      notes.pixels_per_mm = plausible_resolution(big32(data, 0), big32(data, 4), kMmPerMetre);
    }
    if (type == "eXIf") read_exif(data, notes, maker);
    offset += 12 + data.size();
  }
}

void read_bmp_notes(ByteView file, ImageNotes& notes) {
  notes.has_one_bit = little16(file, 28) == 1;
  notes.pixels_per_mm = plausible_resolution(little32(file, 38), little32(file, 42), kMmPerMetre);
}

void read_notes(ByteView file, ImageNotes& notes, Maker& maker) {
  switch (kind_of_image(file)) {
    case ImageKind::png:
      return read_png_notes(file, notes, maker);
    case ImageKind::jpeg:
      return read_jpeg_notes(file, notes, maker);
    case ImageKind::tiff:
      return read_exif(file, notes, maker);
    case ImageKind::bmp:
      return read_bmp_notes(file, notes);
    case ImageKind::gif:
    case ImageKind::pnm:
      return;  // these formats have no metadata
  }
}

}  // namespace

ImageNotes notes_of_image(ByteView file) {
  ImageNotes notes;
  Maker maker = Maker::unknown;
  try {
    read_notes(file, notes, maker);
  } catch (const ImageFault&) {
    // Metadata before the damage stay valid.
  }
  classify_resolution(maker, notes);
  if (notes.orientation < 1 || notes.orientation > 8) notes.orientation = 1;
  return notes;
}

std::string rounded(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", number);
  return text.data();
}

std::vector<std::string> remarks_on(const ImageNotes& notes) {
  std::vector<std::string> remarks;
  if (notes.orientation != 1) {
    remarks.emplace_back(
        "is stored rotated or mirrored, and used as stored; turn it upright and save it again, or "
        "import it");
  }
  if (notes.has_one_bit) {
    remarks.emplace_back(
        "has 1 bit per pixel, black or white; scan or export it in grey if it is a photograph");
  }
  if (notes.pictures > 1) {
    remarks.push_back("contains " + std::to_string(notes.pictures) +
                      " pictures, and the first is used; save the one you want as a separate file");
  }
  if (notes.transparent_share > 0.0) {
    remarks.push_back(rounded(100 * notes.transparent_share) +
                      " % of its pixels are partly transparent and are darkened, and their edge "
                      "can be felt; crop "
                      "it to its opaque part");
  }
  if (notes.heights && !notes.has_user_range) {
    remarks.push_back("contains heights from " + rounded(notes.heights->first) + " to " +
                      rounded(notes.heights->second) +
                      "; import all pictures of a set with the same --heights");
  }
  if (notes.cut_share > 0.0 && !notes.heights) {
    remarks.push_back(rounded(100 * notes.cut_share) +
                      " % of its samples need more than --bits and are cut off, as for hot pixels; "
                      "if the picture has more bits, give that number");
  } else if (notes.cut_share > 0.0) {
    remarks.push_back(rounded(100 * notes.cut_share) +
                      " % of its heights are outside --heights and are cut off, down to " +
                      rounded(notes.heights->first) + " and up to " +
                      rounded(notes.heights->second));
  }
  if (notes.lacks_end) {
    remarks.emplace_back(
        "has no end marker, but has all pixels; copy or export it again if you can");
  }
  return remarks;
}

GreyImage turn_upright(const GreyImage& image, int orientation) {
  if (orientation < 2 || orientation > 8) return image;
  const bool is_transposed = orientation >= 5;
  const bool reads_from_right =
      orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool reads_from_bottom =
      orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  GreyImage result(is_transposed ? image.width() : image.height(),
                   is_transposed ? image.height() : image.width());
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      const int row = is_transposed ? x : y;
      const int column = is_transposed ? y : x;
      result.at(y, x) = image.at(reads_from_bottom ? image.height() - 1 - row : row,
                                 reads_from_right ? image.width() - 1 - column : column);
    }
  }
  return result;
}

}  // namespace touchtrial::engine
