#include "engine/image_file.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/image_formats/image_format.hpp"
#include "image_samples.hpp"
#include "support/catch.hpp"

#include <algorithm>
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
      REQUIRE(over_black(c, alpha) ==
              static_cast<std::uint32_t>(std::floor(c * alpha / 255.0 + 0.5)));
    }
  }
  CHECK(luma(255, 255, 255) == 255);
  CHECK(luma(10, 20, 30) == 18);
}

// The PNG files below come from an encoder that uses zlib alone, not libpng.

TEST_CASE("a grey PNG of any bit depth keeps its samples, spread over 0 to 255") {
  // Samples 1 0 1 0, then 0 1 2 3, then 0 5 10 15.
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d4948445200000004000000010100000000d14732600000000a494441"
                "54789c6358000000a200a1dc8db1cc0000000049454e44ae426082")) == Row{255, 0, 255, 0});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d494844520000000400000001020000000096e748b00000000a494441"
                "54789c63900600001d001c8ef4f5210000000049454e44ae426082")) == Row{0, 85, 170, 255});
  CHECK(first_row(hex(
            "89504e470d0a1a0a0000000d494844520000000400000001040000000019a7bd100000000b494441"
            "54789c63605d0f0000bc00b58241829c0000000049454e44ae426082")) == Row{0, 85, 170, 255});
}

TEST_CASE("a 16-bit grey PNG is divided by 257 and rounded") {
  // 0 1000 65535
  CHECK(first_row(hex(
            "89504e470d0a1a0a0000000d49484452000000030000000110000000006e1b972b0000000f494441"
            "54789c636060607ef1ff3f0005c802ea946684050000000049454e44ae426082")) == Row{0, 4, 255});
}

TEST_CASE("the transparent level of a grey PNG becomes black") {
  // 0 5 100 255 with 100 transparent; in 2 bits 0 1 2 3 with 2; in 16 bits 0 1000 65535 with 1000.
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d4948445200000004000000010800000000dc5750110000000274524e"
                "5300643c4c68790000000d49444154789c6360604df90f0001db0169295a14890000000049454e44"
                "ae426082")) == Row{0, 5, 0, 255});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d494844520000000400000001020000000096e748b00000000274524e"
                "530002989dac140000000a49444154789c63900600001d001c8ef4f5210000000049454e44ae4260"
                "82")) == Row{0, 85, 0, 255});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d49484452000000030000000110000000006e1b972b0000000274524e"
                "5303e8f36ff4b10000000f49444154789c636060607ef1ff3f0005c802ea94668405000000004945"
                "4e44ae426082")) == Row{0, 0, 255});
}

TEST_CASE("grey with alpha in a PNG is composited on black") {
  // (10, 255) (100, 128) (200, 0), and in 16 bits (1000, 65535) (30000, 30000) (60000, 0).
  CHECK(first_row(hex(
            "89504e470d0a1a0a0000000d4948445200000003000000010804000000b1e9dc3f0000000f494441"
            "54789c63e0fa9fd27082010009de02b63030cb0e0000000049454e44ae426082")) == Row{10, 50, 0});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d4948445200000003000000011004000000e179007c00000015494441"
                "54789c63607ef1ff7fa941a9c1ab040606002a84057e71bc73200000000049454e44ae426082")) ==
        Row{4, 54, 0});
}

TEST_CASE("colour with alpha in a PNG is composited on black, then made grey") {
  // (10, 20, 30, 255) (100, 110, 120, 128) (200, 210, 220, 0); in 16 bits (1000, 2000, 3000,
  // 65535) (30000, 31000, 32000, 20000), which is (117, 121, 125, 78) in 8.
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d49484452000000030000000108060000001be014b400000015494441"
                "54789c63e01291fb9f9257d170e2d21d06001e44057c748bf1990000000049454e44ae426082")) ==
        Row{18, 54, 0});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d4948445200000002000000011006000000a4b2a3c900000019494441"
                "54789c63607ec17e817bc7ffffa5069512b50c7e0a003f1a06a5ed93baa60000000049454e44ae42"
                "6082")) == Row{7, 37});
}

TEST_CASE("16-bit colour in a PNG is rounded channel by channel, then made grey") {
  // (1000, 2000, 3000) (30000, 31000, 32000)
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d49484452000000020000000110020000002bd0349e00000015494441"
                "54789c63607ec17e817b47a941a5442d03001df30439a412a16e0000000049454e44ae426082")) ==
        Row{7, 120});
}

TEST_CASE("the transparent colour of a PNG becomes black") {
  // The second pixel's colour is named transparent, in 8 and in 16 bits.
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d49484452000000020000000108020000007b40e8dd0000000674524e"
                "530064006e00781e83c9380000000f49444154789c636064624ec9ab000002a30151d42ef2c30000"
                "000049454e44ae426082")) == Row{2, 0});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d49484452000000020000000110020000002bd0349e0000000674524e"
                "53753079187d000afb39000000001549444154789c63607ec17e817b47a941a5442d03001df30439"
                "a412a16e0000000049454e44ae426082")) == Row{7, 0});
}

TEST_CASE("a PNG's palette and its transparency are looked up") {
  // (1, 2, 3) (100, 110, 120) (250, 0, 9): opaque; then with alpha 255, 128; the same in 2 bits.
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d49484452000000030000000108030000002c3ee48600000009504c54"
                "45010203646e78fa00093db6a2d20000000c49444154789c6360606402000008000436e0b0a60000"
                "000049454e44ae426082")) == Row{2, 108, 76});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d49484452000000030000000108030000002c3ee48600000009504c54"
                "45010203646e78fa00093db6a2d20000000274524e53ff80080fb36a0000000c49444154789c6360"
                "606402000008000436e0b0a60000000049454e44ae426082")) == Row{2, 54, 76});
  CHECK(first_row(
            hex("89504e470d0a1a0a0000000d4948445200000003000000010203000000668efc2700000009504c54"
                "45010203646e78fa00093db6a2d20000000274524e53ff80080fb36a0000000a49444154789c6390"
                "0000001a00192d88f4360000000049454e44ae426082")) == Row{2, 54, 76});
}

TEST_CASE("a 24-bit PNG follows the grey formula, not the decoder's own grey") {
  const Raster picture = colour_picture();
  const GreyImage grey = read_bytes(png_file(picture));
  REQUIRE(grey.height() == 48);
  REQUIRE(grey.width() == 64);
  for (std::size_t i = 0; i < grey.size(); ++i) REQUIRE(grey.samples()[i] == grey_at(picture, i));
}

TEST_CASE("an interlaced PNG is put together from its passes") {
  const GreyImage grey = read_bytes(
      hex("89504e470d0a1a0a0000000d4948445200000003000000020800000001cf180950000000124944415478"
          "9c636064606660626061650300004e00163121d02c0000000049454e44ae426082"));
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
  CHECK(first_row(Tiff(3, 2, numbers({257, 514, 771, 0, 0, 0}, 2))
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
  CHECK(read_bytes(tiled_tiff(16, Bytes(512, 7))).at(3, 4) == 7);
  CHECK_THROWS_WITH(read_bytes(tiled_tiff(16, Bytes(511, 7))), holds_text("truncated"));
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
