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

std::optional<double> resolution(double x, double y, double unit_mm) {
  const bool is_square = std::abs(x - y) <= 0.01 * std::max(x, y);
  // Pixel sizes below 1 um or above 100 mm are implausible.
  if (!is_square || !(x / unit_mm >= 0.01) || !(x / unit_mm <= 1000.0)) return std::nullopt;
  // Defaults of programs for an unknown resolution.
  if (is_near(x / unit_mm, 72.0) || is_near(x / unit_mm, 96.0)) return std::nullopt;
  return x / unit_mm;
}

/// Whether Exif data contain an exposure, which only a camera writes.
bool has_exposure(ByteView file, const TiffDirectory& directory) {
  const std::uint32_t at = directory.value(TiffTag::exif_directory, 0);
  if (at == 0) return false;
  const TiffDirectory exif(file, at);
  return std::ranges::any_of(
      std::array{TiffTag::exposure_time, TiffTag::f_number, TiffTag::sensitivity,
                 TiffTag::time_of_exposure, TiffTag::focal_length, TiffTag::lens_model},
      [&](TiffTag tag) { return exif.has(tag); });
}

/// The maker of a picture file, which determines the meaning of its resolution.
enum class Maker {
  unknown,
  named,  ///< a camera or a scanner
  camera,
};

Maker maker_of(ByteView file, const TiffDirectory& directory) {
  if (has_exposure(file, directory)) return Maker::camera;
  const bool is_named = directory.has(TiffTag::make) || directory.has(TiffTag::model);
  return is_named ? Maker::named : Maker::unknown;
}

/// A camera's resolution is unrelated to the object. Cameras and their software always write 180,
/// 240 or 350, which scanners hardly ever use, or 300.
void weigh_resolution(Maker maker, ImageNotes& notes) {
  if (!notes.pixels_per_mm) return;
  const auto is = [&](double dots) { return is_near(*notes.pixels_per_mm, dots); };
  const bool is_of_camera = maker == Maker::camera || is(180.0) || is(240.0) || is(350.0) ||
                            (maker == Maker::named && is(300.0));
  if (!is_of_camera) return;
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
  if (x && y && unit == kInch) notes.pixels_per_mm = resolution(*x, *y, kMmPerInch);
  if (x && y && unit == kCentimetre) notes.pixels_per_mm = resolution(*x, *y, kMmPerCm);
  return notes;
}

/// Exif notes are a TIFF directory within another file.
void take_exif(ByteView exif, ImageNotes& notes, Maker& maker) {
  try {
    const ImageNotes said = notes_of_tiff(exif, maker);
    notes.orientation = said.orientation;
    notes.has_one_bit |= said.has_one_bit;
    if (said.pixels_per_mm) notes.pixels_per_mm = said.pixels_per_mm;
  } catch (const ImageFault&) {
    // Damaged metadata count as absent; other parts of the file may still have some.
  }
}

bool starts_with(ByteView bytes, std::string_view text) {
  return text_of(bytes.first(std::min(bytes.size(), text.size()))) == text;
}

void take_jfif(ByteView data, ImageNotes& notes) {
  const double x = big16(data, 8);
  const double y = big16(data, 10);
  if (data[7] == 1) notes.pixels_per_mm = resolution(x, y, kMmPerInch);
  if (data[7] == 2) notes.pixels_per_mm = resolution(x, y, kMmPerCm);
}

/// Reads the segments before the first scan.
void take_jpeg(ByteView file, ImageNotes& notes, Maker& maker) {
  using namespace std::string_view_literals;
  constexpr std::uint32_t kScan = 0xFFDA;
  for (std::size_t at = 2; big16(file, at) >= 0xFFC0 && big16(file, at) != kScan;) {
    const ByteView data = bytes_at(file, at + 4, std::max(big16(file, at + 2), 2U) - 2);
    if (big16(file, at) == 0xFFE0 && starts_with(data, "JFIF\0"sv)) take_jfif(data, notes);
    if (big16(file, at) == 0xFFE1 && starts_with(data, "Exif\0\0"sv)) {
      take_exif(data.subspan(6), notes, maker);
    }
    at += 4 + data.size();
  }
}

void take_png(ByteView file, ImageNotes& notes, Maker& maker) {
  for (std::size_t at = 8; at < file.size();) {
    const ByteView data = bytes_at(file, at + 8, big32(file, at));
    const std::string type = text_of(bytes_at(file, at + 4, 4));
    if (type == "IEND") return;
    if (type == "IHDR" && data.size() == 13) notes.has_one_bit = data[8] == 1;
    if (type == "pHYs" && data.size() == 9 && data[8] == 1) {
      notes.pixels_per_mm = resolution(big32(data, 0), big32(data, 4), kMmPerMetre);
    }
    if (type == "eXIf") take_exif(data, notes, maker);
    at += 12 + data.size();
  }
}

void take_bmp(ByteView file, ImageNotes& notes) {
  notes.has_one_bit = little16(file, 28) == 1;
  notes.pixels_per_mm = resolution(little32(file, 38), little32(file, 42), kMmPerMetre);
}

void take_notes(ByteView file, ImageNotes& notes, Maker& maker) {
  switch (kind_of_image(file)) {
    case ImageKind::png:
      return take_png(file, notes, maker);
    case ImageKind::jpeg:
      return take_jpeg(file, notes, maker);
    case ImageKind::tiff:
      return take_exif(file, notes, maker);
    case ImageKind::bmp:
      return take_bmp(file, notes);
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
    take_notes(file, notes, maker);
  } catch (const ImageFault&) {
    // Metadata before the damage stay valid.
  }
  weigh_resolution(maker, notes);
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
        "has 1 bit a pixel, black or white; scan or export it in grey if it is a photograph");
  }
  if (notes.pictures > 1) {
    remarks.push_back("holds " + std::to_string(notes.pictures) +
                      " pictures, and the first is used; save the one you want as a separate file");
  }
  if (notes.transparent_share > 0.0) {
    remarks.push_back(
        rounded(100 * notes.transparent_share) +
        " % of its pixels are transparent to some degree and are darkened, whose edge "
        "can be felt; crop it to where it is opaque");
  }
  if (notes.heights && !notes.has_given_heights) {
    remarks.push_back("holds heights from " + rounded(notes.heights->first) + " to " +
                      rounded(notes.heights->second) +
                      "; import all pictures of a set with the same --heights");
  }
  if (notes.cut_share > 0.0 && !notes.heights) {
    remarks.push_back(rounded(100 * notes.cut_share) +
                      " % of its samples take more than --bits and are cut off, as those of hot "
                      "pixels are; if the picture has more bits, give them");
  } else if (notes.cut_share > 0.0) {
    remarks.push_back(rounded(100 * notes.cut_share) +
                      " % of its heights lie outside --heights and are cut off, down to " +
                      rounded(notes.heights->first) + " and up to " +
                      rounded(notes.heights->second));
  }
  if (notes.lacks_end) {
    remarks.emplace_back(
        "lacks its end marker, but has all pixels; copy or export it again if you can");
  }
  return remarks;
}

GreyImage upright(const GreyImage& image, int orientation) {
  if (orientation < 2 || orientation > 8) return image;
  const bool transposed = orientation >= 5;
  const bool from_right =
      orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_bottom =
      orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  GreyImage turned(transposed ? image.width() : image.height(),
                   transposed ? image.height() : image.width());
  for (int y = 0; y < turned.height(); ++y) {
    for (int x = 0; x < turned.width(); ++x) {
      const int row = transposed ? x : y;
      const int column = transposed ? y : x;
      turned.at(y, x) = image.at(from_bottom ? image.height() - 1 - row : row,
                                 from_right ? image.width() - 1 - column : column);
    }
  }
  return turned;
}

}  // namespace touchtrial::engine
