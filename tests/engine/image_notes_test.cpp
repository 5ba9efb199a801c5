#include "engine/image_notes.hpp"

#include "support/catch.hpp"

#include <string>

using namespace touchtrial;
using namespace touchtrial::engine;
using namespace std::string_literals;

namespace {

std::string big(std::uint32_t number, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(number >> (8 * i) & 0xFFU);
  return text;
}

/// A TIFF directory that says orientation and resolution.
std::string directory(std::uint32_t orientation, std::uint32_t dots, std::uint32_t unit) {
  const auto entry = [](std::uint32_t tag, std::uint32_t type, const std::string& value) {
    return big(tag, 2) + big(type, 2) + big(1, 4) + value;
  };
  const std::uint32_t after = 8 + 2 + 4 * 12 + 4;
  return "MM\0*"s + big(8, 4) + big(4, 2) + entry(274, 3, big(orientation, 2) + "\0\0"s) +
         entry(282, 5, big(after, 4)) + entry(283, 5, big(after, 4)) +
         entry(296, 3, big(unit, 2) + "\0\0"s) + big(0, 4) + big(dots * 10, 4) + big(10, 4);
}

std::string jpeg(const std::string& marker, const std::string& data) {
  return "\xff\xd8"s + marker + big(static_cast<std::uint32_t>(data.size()) + 2, 2) + data +
         "\xff\xda\0\x08"s;
}

std::string png(const std::string& type, const std::string& data) {
  return "\x89PNG\r\n\x1a\n"s + big(static_cast<std::uint32_t>(data.size()), 4) + type + data +
         "sums";
}

ImageNotes notes_of(const std::string& file) {
  return notes_of_image(bytes_of(file));
}

}  // namespace

TEST_CASE("orientation and resolution are found in every kind of file that has them") {
  const std::string exif = directory(6, 300, 2);
  for (const std::string& file : {exif, jpeg("\xff\xe1", "Exif\0\0"s + exif), png("eXIf", exif)}) {
    const ImageNotes notes = notes_of(file);
    CHECK(notes.orientation == 6);
    REQUIRE(notes.pixels_per_mm.has_value());
    CHECK(*notes.pixels_per_mm == Approx(300 / 25.4));
  }
  const ImageNotes in_cm = notes_of(directory(1, 200, 3));
  CHECK(*in_cm.pixels_per_mm == Approx(20.0));
  const ImageNotes jfif = notes_of(jpeg("\xff\xe0", "JFIF\0\1\1\2"s + big(50, 2) + big(50, 2)));
  CHECK(*jfif.pixels_per_mm == Approx(5.0));
  const ImageNotes phys = notes_of(png("pHYs", big(11811, 4) + big(11811, 4) + "\1"));
  CHECK(*phys.pixels_per_mm == Approx(11.811));
}

TEST_CASE("a picture that is stored turned, or in 1 bit, is remarked on") {
  CHECK(remarks_on(notes_of(directory(1, 300, 2))).empty());
  CHECK_FALSE(remarks_on(notes_of(directory(6, 300, 2))).empty());
  for (const char bits : {'\1', '\x8'}) {
    const std::string header = big(20, 4) + big(30, 4) + bits + "\0\0\0\0"s;
    const std::string bitmap = "BM"s + std::string(26, '\0') + bits + std::string(30, '\0');
    const std::string tiff = "MM\0*"s + big(8, 4) + big(1, 2) + big(258, 2) + big(3, 2) +
                             big(1, 4) + "\0"s + bits + "\0\0"s + big(0, 4);
    for (const std::string& file : {png("IHDR", header), bitmap, tiff}) {
      CHECK(remarks_on(notes_of(file)).size() == (bits == 1 ? 1 : 0));
    }
  }
}

TEST_CASE("a resolution that a camera wrote says nothing of the object") {
  // A directory with a resolution, the name of a maker, and notes on the exposure behind it.
  const auto camera = [](std::uint32_t dots, bool is_named, bool has_exposure) {
    const auto entry = [](std::uint32_t tag, std::uint32_t type, const std::string& value) {
      return big(tag, 2) + big(type, 2) + big(1, 4) + value;
    };
    const std::uint32_t after = 8 + 2 + 5 * 12 + 4;
    const std::string name = entry(is_named ? 271 : 270, 2, "A\0\0\0"s);
    return "MM\0*"s + big(8, 4) + big(5, 2) + name + entry(282, 5, big(after, 4)) +
           entry(283, 5, big(after, 4)) + entry(296, 3, big(2, 2) + "\0\0"s) +
           entry(has_exposure ? 34665 : 34666, 4, big(after + 8, 4)) + big(0, 4) + big(dots, 4) +
           big(1, 4) + big(1, 2) + entry(33434, 5, big(after, 4)) + big(0, 4);
  };
  for (const std::uint32_t dots : {180U, 240U, 300U, 350U}) {
    CHECK_FALSE(notes_of(camera(dots, true, false)).pixels_per_mm.has_value());
    CHECK(notes_of(camera(dots, true, false)).camera_dpi == Approx(dots));
    CHECK(notes_of(camera(dots, false, false)).pixels_per_mm.has_value() == (dots == 300));
  }
  CHECK_FALSE(notes_of(camera(600, false, true)).pixels_per_mm.has_value());
  CHECK(notes_of(camera(600, true, false)).pixels_per_mm.has_value());  // a scanner's
  const std::string jfif =
      "\xff\xe0"s + big(16, 2) + "JFIF\0\1\1\1"s + big(300, 2) + big(300, 2) + "\0\0"s;
  const std::string exif = "Exif\0\0"s + camera(72, true, true);
  CHECK_FALSE(
      notes_of("\xff\xd8"s + jfif + jpeg("\xff\xe1", exif).substr(2)).pixels_per_mm.has_value());
}

TEST_CASE("placeholders and unusable resolutions count as absent") {
  CHECK_FALSE(notes_of(directory(1, 72, 2)).pixels_per_mm.has_value());
  CHECK_FALSE(notes_of(directory(1, 96, 2)).pixels_per_mm.has_value());
  CHECK_FALSE(notes_of(directory(1, 300, 1)).pixels_per_mm.has_value());
  CHECK_FALSE(notes_of(directory(1, 0, 2)).pixels_per_mm.has_value());
  CHECK_FALSE(notes_of(png("pHYs", big(2835, 4) + big(2835, 4) + "\1")).pixels_per_mm.has_value());
  CHECK_FALSE(notes_of(png("pHYs", big(5000, 4) + big(9000, 4) + "\1")).pixels_per_mm.has_value());
  CHECK(notes_of(directory(9, 300, 2)).orientation == 1);
}

TEST_CASE("damaged notes count as absent, at whatever byte the file ends") {
  for (const std::string& file :
       {jpeg("\xff\xe1", "Exif\0\0"s + directory(6, 300, 2)), png("eXIf", directory(6, 300, 2)),
        directory(6, 300, 2), jpeg("\xff\xe0", "JFIF\0\1"s), "BM"s, "junk"s}) {
    for (std::size_t length = 0; length < file.size(); ++length) {
      const ImageNotes notes = notes_of(file.substr(0, length));
      CHECK((notes.orientation == 1 || notes.orientation == 6));
    }
  }
}

TEST_CASE("a picture is turned upright by each of the eight orientations") {
  // As it should be seen: 1 2 3 over 4 5 6.
  GreyImage seen(2, 3);
  for (std::size_t i = 0; i < 6; ++i) seen.samples()[i] = static_cast<std::uint8_t>(i + 1);
  const auto stored = [](int height, int width, const std::string& samples) {
    GreyImage image(height, width);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      image.samples()[i] = static_cast<std::uint8_t>(samples[i] - '0');
    }
    return image;
  };
  CHECK(turn_upright(seen, 1) == seen);
  CHECK(turn_upright(stored(2, 3, "321654"), 2) == seen);
  CHECK(turn_upright(stored(2, 3, "654321"), 3) == seen);
  CHECK(turn_upright(stored(2, 3, "456123"), 4) == seen);
  CHECK(turn_upright(stored(3, 2, "142536"), 5) == seen);
  CHECK(turn_upright(stored(3, 2, "362514"), 6) == seen);
  CHECK(turn_upright(stored(3, 2, "635241"), 7) == seen);
  CHECK(turn_upright(stored(3, 2, "415263"), 8) == seen);
  CHECK(turn_upright(seen, 0) == seen);
}
