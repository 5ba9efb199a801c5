#include "stimuli/import/photograph.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "engine/image_file.hpp"
#include "engine/image_notes.hpp"
#include "engine/pictures/colour_image.hpp"

#include <cmath>

namespace touchtrial::stimuli {
namespace {

constexpr double kMostEnlarged = 4.0;
constexpr double kMostShrunk = 1.0 / 64;

double scale_for(const Photograph& photo, const ImportOptions& options) {
  const std::string name = one_line(photo.path.string());
  const auto pixels_per_mm =
      options.pixels_per_mm_of_files ? photo.said_pixels_per_mm : options.pixels_per_mm;
  if (!pixels_per_mm && !options.pixels_per_mm_of_files) return 1.0;
  if (!pixels_per_mm) {
    throw FileError(name +
                    ": does not say how many pixels a millimetre has (72 and 96 dpi are what "
                    "programs write that do not know); give --pixels-per-mm a number");
  }
  const double scale = 1.0 / (*pixels_per_mm * options.pitch_mm);
  if (scale > kMostEnlarged || scale < kMostShrunk) {
    throw FileError(name + ": " + number_text(*pixels_per_mm) +
                    " pixels a millimetre at a pitch of " + number_text(options.pitch_mm) +
                    " mm means scaling by " + number_text(scale) +
                    ", beyond 1/64 to 4; check --pixels-per-mm and --pitch-mm");
  }
  return scale;
}

int scaled(int length_px, double scale) {
  return static_cast<int>(std::max(1L, std::lround(length_px * scale)));
}

}  // namespace

Photograph read_photograph(const std::filesystem::path& path, const ImportOptions& options) {
  const Bytes file = read_file(path);
  const engine::ImageNotes notes = engine::notes_of_image(file);
  Photograph photo;
  photo.path = path;
  photo.image = engine::upright(engine::decode_grey_image(file, path.string()), notes.orientation);
  photo.sha256 = sha256(file);
  photo.pixels_sha256 = FieldHasher()
                            .add(std::int64_t{photo.image.height()})
                            .add(std::int64_t{photo.image.width()})
                            .add(ByteView(photo.image.samples()))
                            .finish();
  photo.orientation = notes.orientation;
  photo.height_px = photo.image.height();
  photo.width_px = photo.image.width();
  photo.said_pixels_per_mm = notes.pixels_per_mm;
  photo.scale = scale_for(photo, options);
  if (photo.scale != 1.0) {
    photo.image = engine::resized(photo.image, scaled(photo.height_px, photo.scale),
                                  scaled(photo.width_px, photo.scale));
  }
  return photo;
}

}  // namespace touchtrial::stimuli
