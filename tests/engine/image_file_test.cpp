#include "engine/image_file.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/image_formats/image_format.hpp"
#include "engine/image_samples.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <thread>

using namespace touchtrial;
using namespace touchtrial::engine;
using namespace touchtrial::samples;
using Row = std::vector<int>;

TEST_CASE("the integer sample rules are the rounded formulas") {
  for (std::uint32_t v = 0; v <= 65535; ++v) {
    REQUIRE(to_8_bit(static_cast<std::uint16_t>(v)) ==
            static_cast<std::uint32_t>(std::floor(v / 257.0 + 0.5)));
    REQUIRE(to_8_bit(v, 65535) == to_8_bit(static_cast<std::uint16_t>(v)));
  }
  for (std::uint32_t alpha = 0; alpha <= 255; ++alpha) {
    for (std::uint32_t c = 0; c <= 255; ++c) {
      REQUIRE(composite_on_black(c, alpha) ==
              static_cast<std::uint32_t>(std::floor(c * alpha / 255.0 + 0.5)));
    }
  }
  CHECK(luma(255, 255, 255) == 255);
  CHECK(luma(10, 20, 30) == 18);
}

TEST_CASE(
    "PNG samples of any depth, with alpha, transparent colours and palettes follow the rules") {
  const Bytes grey16 = hex("00000003e8ffff");                // 0 1000 65535
  const Bytes colour16 = hex("0003e807d00bb8753079187d00");  // (1000, 2000, 3000) (30000, ..)
  const Bytes palette = hex("010203646e78fa0009");
  struct Case {
    std::string what;
    Png png;
    Row expected;
  };
  const std::vector<Case> cases = {
      {"1 0 1 0", {4, 1, 1, Png::kGrey, hex("00a0")}, {255, 0, 255, 0}},
      {"0 1 2 3 of 3", {4, 1, 2, Png::kGrey, hex("001b")}, {0, 85, 170, 255}},
      {"0 5 10 15 of 15", {4, 1, 4, Png::kGrey, hex("0005af")}, {0, 85, 170, 255}},
      {"16-bit grey", {3, 1, 16, Png::kGrey, grey16}, {0, 4, 255}},
      {"100 transparent", {4, 1, 8, Png::kGrey, hex("00000564ff"), hex("0064")}, {0, 5, 0, 255}},
      {"2 of 3 transparent", {4, 1, 2, Png::kGrey, hex("001b"), hex("0002")}, {0, 85, 0, 255}},
      {"1000 transparent", {3, 1, 16, Png::kGrey, grey16, hex("03e8")}, {0, 0, 255}},
      {"(10, 255) (100, 128) (200, 0)",
       {3, 1, 8, Png::kGreyAlpha, hex("000aff6480c800")},
       {10, 50, 0}},
      {"(1000, 65535) (30000, 30000) (60000, 0)",
       {3, 1, 16, Png::kGreyAlpha, hex("0003e8ffff75307530ea600000")},
       {4, 54, 0}},
      {"(10, 20, 30, 255) (100, 110, 120, 128) (200, 210, 220, 0)",
       {3, 1, 8, Png::kColourAlpha, hex("000a141eff646e7880c8d2dc00")},
       {18, 54, 0}},
      // (117, 121, 125, 78) in 8 bits.
      {"(1000, 2000, 3000, 65535) (30000, 31000, 32000, 20000)",
       {2, 1, 16, Png::kColourAlpha, hex("0003e807d00bb8ffff753079187d004e20")},
       {7, 37}},
      {"16-bit colour", {2, 1, 16, Png::kColour, colour16}, {7, 120}},
      {"the second colour transparent",
       {2, 1, 8, Png::kColour, hex("00010203646e78"), hex("0064006e0078")},
       {2, 0}},
      {"the second 16-bit colour transparent",
       {2, 1, 16, Png::kColour, colour16, hex("753079187d00")},
       {7, 0}},
      {"a palette", {3, 1, 8, Png::kPalette, hex("00000102"), {}, palette}, {2, 108, 76}},
      {"a palette with alpha 255, 128",
       {3, 1, 8, Png::kPalette, hex("00000102"), hex("ff80"), palette},
       {2, 54, 76}},
      {"a palette with alpha, in 2 bits",
       {3, 1, 2, Png::kPalette, hex("0018"), hex("ff80"), palette},
       {2, 54, 76}},
  };
  for (const auto& [what, png, expected] : cases) {
    INFO(what);
    CHECK(first_row(png.bytes()) == expected);
  }
}

TEST_CASE("a 24-bit PNG follows the grey formula, not the decoder's own grey") {
  const Raster picture = colour_picture();
  const GreyImage grey = read_bytes(png_file(picture));
  REQUIRE(grey.height() == 48);
  REQUIRE(grey.width() == 64);
  for (std::size_t i = 0; i < grey.size(); ++i) REQUIRE(grey.samples()[i] == grey_at(picture, i));
}

TEST_CASE("an interlaced PNG is put together from its passes") {
  Png png{3, 2, 8, Png::kGrey, hex("00010003000200040506")};
  png.interlaced = 1;
  const GreyImage grey = read_bytes(png.bytes());
  CHECK(Row(grey.row(0).begin(), grey.row(0).end()) == Row{1, 2, 3});
  CHECK(Row(grey.row(1).begin(), grey.row(1).end()) == Row{4, 5, 6});
}

TEST_CASE("a grey picture survives writing and reading unchanged") {
  const TempFolder folder;
  GreyImage image(3, 257);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.samples()[i] = static_cast<std::uint8_t>(i * i / 7);
  }
  write_png(folder.path() / "a.png", image);
  write_png(folder.path() / "b.png", image);
  CHECK(read_grey_image(folder.path() / "a.png") == image);
  CHECK(read_file(folder.path() / "a.png") == read_file(folder.path() / "b.png"));
}

TEST_CASE("write_png refuses an empty picture and a folder that is not there") {
  const TempFolder folder;
  CHECK_THROWS_AS(write_png(folder.path() / "a.png", GreyImage()), std::invalid_argument);
  CHECK_THROWS_AS(write_png(folder.path() / "none" / "a.png", GreyImage(1, 1)), FileError);
}

TEST_CASE("TIFF samples of either byte order follow the rules") {
  const bool big = GENERATE(false, true);
  const auto wide = [&](std::initializer_list<std::uint32_t> samples) {
    return numbers(samples, 2, big);
  };
  CHECK(first_row(Tiff(3, 1, {0, 5, 255}, big).bytes()) == Row{0, 5, 255});
  CHECK(first_row(Tiff(3, 1, {0, 5, 255}, big).with(262, {0}).bytes()) == Row{255, 250, 0});
  CHECK(first_row(Tiff(3, 1, wide({0, 1000, 65535}), big).with(258, {16}).bytes()) ==
        Row{0, 4, 255});
  CHECK(first_row(Tiff(3, 1, wide({0, 1000, 65535}), big).with(258, {16}).with(262, {0}).bytes()) ==
        Row{255, 251, 0});
  CHECK(first_row(Tiff(4, 1, {0b10100000}, big).with(258, {1}).bytes()) == Row{255, 0, 255, 0});
  CHECK(first_row(Tiff(2, 1, {1, 2, 3, 100, 110, 120}, big)
                      .with(258, {8, 8, 8})
                      .with(262, {2})
                      .with(277, {3})
                      .bytes()) == Row{2, 108});
  CHECK(first_row(Tiff(2, 1, wide({1000, 2000, 3000, 30000, 31000, 32000}), big)
                      .with(258, {16, 16, 16})
                      .with(262, {2})
                      .with(277, {3})
                      .bytes()) == Row{7, 120});
}

TEST_CASE("alpha in a TIFF is composited unless it is premultiplied or no alpha") {
  // 2: straight alpha; 1: colours are multiplied already; 0: an unnamed channel.
  const auto [meaning, expected8, expected16, expected_grey] =
      GENERATE(table<std::uint32_t, Row, Row, Row>({{2, {18, 54}, {7, 37}, {10, 50}},
                                                    {1, {18, 108}, {7, 120}, {10, 100}},
                                                    {0, {18, 108}, {7, 120}, {10, 100}}}));
  CHECK(first_row(Tiff(2, 1, {10, 20, 30, 255, 100, 110, 120, 128})
                      .with(258, {8, 8, 8, 8})
                      .with(262, {2})
                      .with(277, {4})
                      .with(338, {meaning})
                      .bytes()) == expected8);
  CHECK(first_row(Tiff(2, 1, numbers({1000, 2000, 3000, 65535, 30000, 31000, 32000, 20000}, 2))
                      .with(258, {16, 16, 16, 16})
                      .with(262, {2})
                      .with(277, {4})
                      .with(338, {meaning})
                      .bytes()) == expected16);
  CHECK(first_row(Tiff(2, 1, {10, 255, 100, 128})
                      .with(258, {8, 8})
                      .with(277, {2})
                      .with(338, {meaning})
                      .bytes()) == expected_grey);
}

TEST_CASE("16-bit grey with alpha in a TIFF is composited on black") {
  const bool big = GENERATE(false, true);
  CHECK(first_row(Tiff(2, 1, numbers({1000, 65535, 30000, 20000}, 2, big), big)
                      .with(258, {16, 16})
                      .with(277, {2})
                      .with(338, {2})
                      .bytes()) == Row{4, 36});
}

TEST_CASE("a fourth TIFF channel without a description is alpha") {
  CHECK(first_row(Tiff(2, 1, {10, 20, 30, 255, 100, 110, 120, 128})
                      .with(258, {8, 8, 8, 8})
                      .with(262, {2})
                      .with(277, {4})
                      .bytes()) == Row{18, 54});
}

TEST_CASE("a TIFF's orientation is ignored, in 8 and 16 bits") {
  const auto orientation = static_cast<std::uint32_t>(GENERATE(1, 2, 3, 4, 5, 6, 7, 8));
  CHECK(first_row(Tiff(3, 2, {1, 2, 3, 4, 5, 6}).with(274, {orientation}).bytes()) == Row{1, 2, 3});
  CHECK(first_row(Tiff(3, 2, numbers({257, 514, 771, 0, 0, 65535}, 2))
                      .with(258, {16})
                      .with(274, {orientation})
                      .bytes()) == Row{1, 2, 3});
}

TEST_CASE("a compressed TIFF decodes to what was encoded") {
  const Raster colour = colour_picture();
  Raster grey{colour.height, colour.width, 1, 8, {}};
  for (std::size_t i = 0; i < colour.samples.size(); i += 3) {
    grey.samples.push_back(colour.samples[i + 1]);
  }
  const auto compression = static_cast<std::uint16_t>(GENERATE(1, 5, 8, 32773));
  const GreyImage image = read_bytes(tiff_file(grey, compression));
  CHECK(std::ranges::equal(image.samples(), grey.samples));
  const GreyImage of_colour = read_bytes(tiff_file(colour, compression));
  for (std::size_t i = 0; i < image.size(); ++i) {
    REQUIRE(of_colour.samples()[i] == grey_at(colour, i));
  }
}

/// A TIFF of one 16 x 16 tile; the picture is its upper left corner.
Bytes tiled_tiff(std::uint32_t bits, const Bytes& tile) {
  Tiff tiff(5, 4, tile);
  for (const std::uint32_t strips : {273U, 278U, 279U}) tiff.entries.erase(strips);
  const auto size = static_cast<std::uint32_t>(tile.size());
  return tiff.with(258, {bits})
      .with(322, {16})
      .with(323, {16})
      .with(324, {8})
      .with(325, {size})
      .bytes();
}

TEST_CASE("a TIFF in 16-bit tiles is read, and refused if a tile is short") {
  CHECK(read_bytes(tiled_tiff(16, Bytes(512, 0x70))).at(3, 4) == 0x70);
  CHECK_THROWS_WITH(read_bytes(tiled_tiff(16, Bytes(511, 7))), names("[truncated-picture]"));
}

TEST_CASE("a TIFF in tiles of four 8-bit channels is read") {
  Tiff tiff(5, 4, Bytes(1024, 255));
  for (const std::uint32_t strips : {273U, 278U, 279U}) tiff.entries.erase(strips);
  tiff.with(258, {8, 8, 8, 8}).with(262, {2}).with(277, {4});
  tiff.with(322, {16}).with(323, {16}).with(324, {8}).with(325, {1024});
  CHECK(first_row(tiff.bytes()) == Row{255, 255, 255, 255, 255});
}

TEST_CASE("a TIFF in 8-bit or bilevel tiles without compression is read") {
  Bytes tile(256);
  for (std::size_t i = 0; i < tile.size(); ++i) tile[i] = static_cast<std::uint8_t>(i);
  CHECK(first_row(tiled_tiff(8, tile)) == Row{0, 1, 2, 3, 4});
  CHECK(read_bytes(tiled_tiff(8, tile)).at(3, 4) == 3 * 16 + 4);
  CHECK(first_row(tiled_tiff(1, Bytes(32, 0b10100000))) == Row{255, 0, 255, 0, 0});
}

TEST_CASE("grey with alpha in a TIFF is read with and without a predictor") {
  // (10, 255) (90, 129) by PackBits; then (10, 255) (100, 128) by deflate and predictor 2.
  const Bytes differences = {3, 10, 255, 90, 129};
  Tiff tiff(2, 1, differences);
  tiff.with(258, {8, 8}).with(277, {2}).with(338, {2}).with(259, {32773});
  CHECK(first_row(tiff.bytes()) == Row{10, (90 * 129 + 127) / 255});
  const Bytes deflated = hex("789ce3fa1fd50800045e01e5");
  Tiff predicted(2, 1, deflated);
  predicted.with(258, {8, 8}).with(277, {2}).with(338, {2}).with(259, {8}).with(317, {2});
  CHECK(first_row(predicted.bytes()) == Row{10, 50});
}

TEST_CASE("BMP rows from the top or the bottom, palettes and alpha follow the rules") {
  const Bytes rows = {30, 20, 10, 120, 110, 100, 0, 0, 1, 1, 1, 2, 2, 2, 0, 0};
  CHECK(first_row(Bmp{2, 2, 24, rows, {}, 0, {}}.bytes()) == Row{1, 2});
  CHECK(first_row(Bmp{2, -2, 24, rows, {}, 0, {}}.bytes()) == Row{18, 108});
  const Bytes palette = {3, 2, 1, 0, 120, 110, 100, 0};
  CHECK(first_row(Bmp{3, 1, 1, {0b01000000, 0, 0, 0}, palette, 0, {}}.bytes()) == Row{2, 108, 2});
  const Bytes pixels = {30, 20, 10, 255, 120, 110, 100, 128};
  const Bytes masks = numbers({0xFF0000, 0xFF00, 0xFF, 0xFF000000}, 4);
  CHECK(first_row(Bmp{2, 1, 32, pixels, {}, 0, {}}.bytes()) == Row{18, 108});
  CHECK(first_row(Bmp{2, 1, 32, pixels, {}, 3, masks}.bytes()) == Row{18, 54});
  CHECK(first_row(Bmp{2, 1, 32, pixels, {}, 3, numbers({0xFF0000, 0xFF00, 0xFF}, 4)}.bytes()) ==
        Row{18, 108});
}

TEST_CASE("BMP palettes of 4 and 8 bits and run lengths follow the rules") {
  const Bytes palette = numbers({0x010203, 0x646E78, 0xFA0009, 0x0A0A0A}, 4);
  Bytes four = Bmp{3, 1, 4, {0x12, 0x30, 0, 0}, palette, 0, {}}.bytes();
  four[46] = 4;  // entries of the palette
  CHECK(first_row(four) == Row{108, 76, 10});
  Bytes eight = Bmp{3, 1, 8, {2, 0, 9, 0}, palette, 0, {}}.bytes();
  eight[46] = 4;
  CHECK(first_row(eight) == Row{76, 2, 0});
  Bytes runs = Bmp{7, 1, 4, {3, 0x12, 0, 3, 0x31, 0x20, 1, 0x30, 0, 1}, palette, 2, {}}.bytes();
  runs[46] = 4;
  CHECK(first_row(runs) == Row{108, 76, 108, 10, 108, 76, 10});
  const GreyImage packed = read_bytes(packed_bmp());
  CHECK(Row(packed.samples().begin(), packed.samples().end()) ==
        Row{30, 30, 30, 30, 30, 0, 0, 20, 0, 0, 10, 10, 10, 20, 30});
}

TEST_CASE("PGM and PPM of any maximum are scaled to 0 to 255 and rounded") {
  using namespace std::string_view_literals;
  CHECK(first_row(text("P5 3 1 255\n\x00\x64\xff"sv)) == Row{0, 100, 255});
  CHECK(first_row(text("P5 # comment 9\n3 1 100\n\x00\x32\x64"sv)) == Row{0, 128, 255});
  CHECK(first_row(text("P5 3 1 65535\n\x00\x00\x03\xe8\xff\xff"sv)) == Row{0, 4, 255});
  CHECK(first_row(text("P2\n3 1\n4\n0 # comment 9\n 2 4")) == Row{0, 128, 255});
  CHECK(first_row(text("P3 2 1 255 1 2 3 100 110 120")) == Row{2, 108});
  CHECK(first_row(text("P6 1 1 1000\n\x00\x00\x01\xf4\x03\xe8"sv)) ==
        Row{(587 * 128 + 114 * 255 + 500) / 1000});
}

TEST_CASE("a GIF is read, its first picture of several, and transparent pixels are black") {
  const Picture plain = decode_picture(gif_file(), "picture");
  CHECK(Row(plain.grey.samples().begin(), plain.grey.samples().end()) == Row{10, 20, 30, 0});
  CHECK(plain.notes.pictures == 1);
  CHECK(plain.notes.transparent_share == 0.0);
  CHECK(remarks_on(plain.notes).empty());
  const Picture several = decode_picture(gif_file(3, 2), "picture");
  CHECK(Row(several.grey.samples().begin(), several.grey.samples().end()) == Row{10, 0, 30, 0});
  CHECK(several.notes.pictures == 3);
  CHECK(several.notes.transparent_share == 0.25);
  CHECK(remarks_on(several.notes).size() == 2);
}

TEST_CASE(
    "16-bit samples that use 14 bits or fewer are scaled by bits that are given, or refused") {
  using namespace std::string_view_literals;
  const auto level = [](const Bytes& file, int bits) {
    return static_cast<int>(
        decode_picture(file, "picture", {.bits = bits, .heights = {}}).grey.at(0, 1));
  };
  const auto files = [](std::uint32_t max) {
    Bytes pgm = text("P5 2 1 65535\n");
    append(pgm, numbers({0, max}, 2, true));
    Bytes row = {0};
    append(row, numbers({0, max}, 2, true));
    return std::vector<Bytes>{pgm, Png{2, 1, 16, Png::kGrey, row}.bytes(),
                              Tiff(2, 1, numbers({0, max}, 2)).with(258, {16}).bytes()};
  };
  for (const Bytes& file : files(4095)) {
    CHECK_THROWS_AS(level(file, 0), FileError);
    CHECK(level(file, 12) == 255);
    CHECK(level(file, 13) == 127);
    CHECK(level(file, 16) == 16);
    CHECK_THROWS_AS(level(file, 11), FileError);
  }
  Bytes opaque = {0};
  append(opaque, numbers({0, 65535, 4095, 65535}, 2, true));
  CHECK_THROWS_AS(level(Png{2, 1, 16, Png::kGreyAlpha, opaque}.bytes(), 0), FileError);
  CHECK(level(Png{2, 1, 16, Png::kGreyAlpha, opaque}.bytes(), 12) == 255);
  const Bytes inverted = Tiff(2, 1, numbers({4095, 0}, 2)).with(258, {16}).with(262, {0}).bytes();
  CHECK_THROWS_AS(level(inverted, 0), FileError);
  CHECK(level(inverted, 12) == 255);
  // One hot pixel in a thousand says nothing of the bits.
  const auto hot = [&](std::size_t count) {
    Bytes pgm = text("P5 1000 1 65535\n");
    for (std::size_t i = 0; i < 1000; ++i) append(pgm, number(i < count ? 65535 : 4095, 2, true));
    return pgm;
  };
  CHECK_THROWS_AS(level(hot(1), 0), FileError);
  CHECK(level(hot(1), 12) == 255);
  CHECK(decode_picture(hot(1), "picture", {.bits = 12, .heights = {}}).notes.cut_share == 0.001);
  CHECK(level(hot(2), 0) == 255);
  CHECK_THROWS_AS(level(hot(2), 12), FileError);
  for (const Bytes& file : files(kMinMaxWideSample)) CHECK(level(file, 0) == 64);
  for (const Bytes& file : files(0)) CHECK(level(file, 0) == 0);
  CHECK(level(text("P5 2 1 4095\n\x00\x00\x0f\xff"sv), 0) == 255);
}

/// The four bytes of a float, as a number.
std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

TEST_CASE(
    "the heights of a floating-point TIFF become grey levels of their own range or a given one") {
  const bool big = GENERATE(false, true);
  const Bytes file =
      Tiff(3, 1, numbers({bits_of(-1.5F), bits_of(0.0F), bits_of(1.5F)}, 4, big), big)
          .with(258, {32})
          .with(339, {3})
          .bytes();
  const auto row = [&](const SampleScale& scale) {
    const Picture picture = decode_picture(file, "picture", scale);
    CHECK(picture.notes.heights == std::pair(-1.5, 1.5));
    return Row(picture.grey.samples().begin(), picture.grey.samples().end());
  };
  CHECK(row({}) == Row{0, 128, 255});
  CHECK(row({.bits = 0, .heights = std::pair(-3.0, 3.0)}) == Row{64, 128, 191});
  CHECK(row({.bits = 0, .heights = std::pair(0.0, 1.0)}) == Row{0, 0, 255});
  const Picture cut = decode_picture(file, "picture", {.bits = 0, .heights = std::pair(0.0, 9.0)});
  CHECK(cut.notes.cut_share == Approx(1.0 / 3));
  CHECK(remarks_on(cut.notes).size() == 1);
  // GDAL_NODATA is a text of four characters here.
  const auto with_gap = [&](float height) {
    const std::uint32_t minus_99 = 0x0039392d;
    Bytes bytes = Tiff(2, 1, numbers({bits_of(height), 0}, 4))
                      .with(258, {32})
                      .with(339, {3})
                      .with(42113, {minus_99})
                      .bytes();
    const Bytes entry = numbers({42113, 4, 1}, 2);
    const auto at = std::ranges::search(bytes, entry).begin();
    at[2] = 2;
    at[4] = 4;
    return bytes;
  };
  for (const float height : {NAN, INFINITY, -3.4e38F, -99.0F}) {
    CHECK_THROWS_WITH(decode_picture(with_gap(height), "picture"), names("1"));
  }
  CHECK_NOTHROW(decode_picture(with_gap(-98.0F), "picture"));
  const Bytes flat = Tiff(2, 1, numbers({0, 0}, 4)).with(258, {32}).with(339, {3}).bytes();
  CHECK(decode_picture(flat, "picture").grey.at(0, 1) == 0);
}

/// A TIFF of several directories with a picture each, of whose first pixel only `pixel` is known.
Bytes tiff_of(const std::vector<std::pair<std::uint32_t, std::uint8_t>>& subfile_and_pixel) {
  Bytes file = text("II*");
  file.push_back(0);
  append(file, number(8, 4));
  for (std::size_t i = 0; i < subfile_and_pixel.size(); ++i) {
    const auto [subfile, pixel] = subfile_and_pixel[i];
    constexpr std::size_t kEntries = 9;
    const std::size_t samples_at = file.size() + 2 + 12 * kEntries + 4;
    const bool is_last = i + 1 == subfile_and_pixel.size();
    append(file, number(kEntries, 2));
    const auto entry = [&](std::uint32_t tag, std::uint64_t value) {
      append(file, numbers({tag, 4}, 2));
      append(file, number(1, 4));
      append(file, number(value, 4));
    };
    entry(254, subfile);
    entry(256, 2);
    entry(257, 1);
    entry(258, 8);
    entry(259, 1);
    entry(262, 1);
    entry(273, samples_at);
    entry(277, 1);
    entry(279, 2);
    append(file, number(is_last ? 0 : samples_at + 2, 4));
    append(file, {pixel, 7});
  }
  return file;
}

TEST_CASE("of a TIFF's pictures the first is read that is no reduced copy") {
  const auto read = [](const Bytes& file) {
    const Picture picture = decode_picture(file, "picture");
    return std::pair<int, int>(picture.grey.at(0, 0), picture.notes.pictures);
  };
  CHECK(read(tiff_of({{0, 9}})) == std::pair(9, 1));
  CHECK(read(tiff_of({{1, 5}, {0, 9}})) == std::pair(9, 1));
  CHECK(read(tiff_of({{1, 5}, {0, 9}, {1, 4}, {2, 8}})) == std::pair(9, 2));
  CHECK(read(tiff_of({{1, 5}, {1, 6}})) == std::pair(5, 1));
  Bytes endless = tiff_of({{0, 9}, {0, 8}});
  std::fill(endless.end() - 6, endless.end() - 2, std::uint8_t{0});
  endless[endless.size() - 6] = 8;  // the last directory leads back to the first
  CHECK(read(endless).first == 9);
}

TEST_CASE("a JPEG without its end marker is read, unless a block may be missing") {
  Bytes file = jpeg_file(colour_picture());
  const GreyImage whole = decode_picture(file, "picture").grey;
  file.resize(file.size() - 2);
  const Picture picture = decode_picture(file, "picture");
  CHECK(picture.grey == whole);
  CHECK(picture.notes.lacks_end);
  CHECK(remarks_on(picture.notes).size() == 1);
  file.pop_back();
  CHECK_THROWS_AS(decode_picture(file, "picture"), FileError);
}

TEST_CASE("opacity is read from every kind of picture that has it") {
  const auto opaque = [](const Bytes& file) {
    const GreyImage image = opacity_of(file, "picture");
    return Row(image.samples().begin(), image.samples().end());
  };
  CHECK(opaque(gif_file(3, 2)) == Row{255, 0, 255, 255});
  CHECK(opaque(Png{3, 1, 8, Png::kGreyAlpha, hex("000aff64fec800")}.bytes()) == Row{255, 0, 0});
  CHECK(opaque(Tiff(2, 1, {10, 255, 100, 128}).with(258, {8, 8}).with(277, {2}).bytes()) ==
        Row{255, 0});
}

TEST_CASE("transparent pixels are counted in every kind of picture that has some") {
  const auto share = [](const Bytes& file) {
    return decode_picture(file, "picture").notes.transparent_share;
  };
  CHECK(share(Png{3, 1, 8, Png::kGreyAlpha, hex("000aff64ffc800")}.bytes()) == Approx(1.0 / 3));
  CHECK(share(Png{4, 1, 8, Png::kGrey, hex("00000564ff"), hex("0064")}.bytes()) == 0.25);
  CHECK(share(Tiff(2, 1, {10, 255, 100, 128}).with(258, {8, 8}).with(277, {2}).bytes()) == 0.5);
  Tiff colour(2, 1, {10, 20, 30, 255, 100, 110, 120, 128});
  colour.with(258, {8, 8, 8, 8}).with(262, {2}).with(277, {4});
  CHECK(share(colour.with(338, {2}).bytes()) == 0.5);
  CHECK(share(colour.with(338, {1}).bytes()) == 0.5);
  CHECK(share(colour.with(338, {0}).bytes()) == 0.0);
  CHECK(share(png_file(colour_picture())) == 0.0);
}

TEST_CASE("a JPEG is made grey from its decoded colours") {
  const int progressive = GENERATE(0, 1);
  const Bytes file = jpeg_file(colour_picture(), progressive == 1);
  const Raster decoded = colours_of_jpeg(file);
  const GreyImage grey = read_bytes(file);
  REQUIRE(grey.size() == std::size_t{48} * 64);
  for (std::size_t i = 0; i < grey.size(); ++i) REQUIRE(grey.samples()[i] == grey_at(decoded, i));
}

TEST_CASE("a JPEG's orientation, comments and bytes after its end change nothing") {
  const Bytes plain = jpeg_file(colour_picture());
  // An Exif segment whose only entry turns the picture by a quarter, and a comment.
  const Bytes notes =
      hex("ffe10022457869660000"
          "4d4d002a00000008000101120003000000010006000000000000"
          "fffe00046869");
  Bytes noted = plain;
  noted.insert(noted.begin() + 2, notes.begin(), notes.end());
  append(noted, text("trailing bytes"));
  CHECK(read_bytes(noted) == read_bytes(plain));
}

TEST_CASE("pictures read by several threads at once are the same as one by one") {
  const TempFolder folder;
  const auto path = folder.path() / "picture.jpg";
  replace_file(path, jpeg_file(colour_picture()));
  const GreyImage expected = read_grey_image(path);
  std::vector<GreyImage> images(4);
  std::vector<std::thread> threads;
  for (GreyImage& image : images) {
    threads.emplace_back([&] { image = read_grey_image(path); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const GreyImage& image : images) CHECK(image == expected);
}
