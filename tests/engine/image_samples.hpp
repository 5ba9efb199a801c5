/// \file Small pictures of every kind, built byte by byte for tests.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"
#include "engine/image_file.hpp"
#include "support/temp_folder.hpp"

#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchtrial::samples {

inline Bytes hex(std::string_view digits) {
  return from_hex(digits).value();
}

inline void append(Bytes& to, const Bytes& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// A number in `size` bytes, least significant first unless `big`.
inline Bytes number(std::uint64_t value, std::size_t size, bool big = false) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) {
    bytes[big ? size - 1 - i : i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  return bytes;
}

inline Bytes numbers(std::initializer_list<std::uint32_t> values, std::size_t size,
                     bool big = false) {
  Bytes bytes;
  for (const std::uint32_t value : values) append(bytes, number(value, size, big));
  return bytes;
}

/// A TIFF of one strip: header, samples, directory. Entries of two values share one field.
struct Tiff {
  bool big = false;
  Bytes samples;
  std::map<std::uint32_t, std::vector<std::uint32_t>> entries;

  Tiff(std::uint32_t width, std::uint32_t height, Bytes data, bool big_endian = false)
      : big(big_endian), samples(std::move(data)) {
    const auto size = static_cast<std::uint32_t>(samples.size());
    entries = {{256, {width}}, {257, {height}}, {258, {8}},      {259, {1}},   {262, {1}},
               {273, {8}},     {277, {1}},      {278, {height}}, {279, {size}}};
  }
  Tiff& with(std::uint32_t tag, std::vector<std::uint32_t> values) {
    entries[tag] = std::move(values);
    return *this;
  }

  [[nodiscard]] Bytes bytes() const {
    Bytes file = bytes_from(big ? "MM" : "II");
    append(file, number(42, 2, big));
    append(file, number(8 + samples.size(), 4, big));
    append(file, samples);
    append(file, number(entries.size(), 2, big));
    Bytes outside;
    const std::size_t outside_at = file.size() + 12 * entries.size() + 4;
    for (const auto& [tag, values] : entries) {
      // One value is a LONG, several are SHORTs.
      const bool is_long = values.size() == 1;
      append(file, number(tag, 2, big));
      append(file, number(is_long ? 4 : 3, 2, big));
      append(file, number(values.size(), 4, big));
      Bytes packed;
      for (const std::uint32_t value : values) append(packed, number(value, is_long ? 4 : 2, big));
      if (packed.size() <= 4) {
        packed.resize(4);
        append(file, packed);
      } else {
        append(file, number(outside_at + outside.size(), 4, big));
        append(outside, packed);
      }
    }
    append(file, number(0, 4, big));
    append(file, outside);
    return file;
  }

 private:
  static Bytes bytes_from(std::string_view text) { return {text.begin(), text.end()}; }
};

/// A BMP with a 40-byte header, or a longer one where `masks` has four numbers.
struct Bmp {
  std::int32_t width = 1;
  std::int32_t height = 1;  ///< negative: rows from the top
  std::uint32_t bits = 24;
  Bytes data;
  Bytes palette;
  std::uint32_t compression = 0;
  Bytes masks;

  [[nodiscard]] Bytes bytes() const {
    const std::size_t header_size = masks.size() == 16 ? 56 : 40;
    const std::size_t data_at = 54 + masks.size() + palette.size();
    Bytes file = {'B', 'M'};
    append(file, number(data_at + data.size(), 4));
    append(file, number(0, 4));
    append(file, number(data_at, 4));
    append(file, number(header_size, 4));
    append(file, number(static_cast<std::uint32_t>(width), 4));
    append(file, number(static_cast<std::uint32_t>(height), 4));
    append(file, number(1, 2));
    append(file, number(bits, 2));
    append(file, number(compression, 4));
    append(file, number(data.size(), 4));
    append(file, Bytes(16));
    append(file, masks);
    append(file, palette);
    append(file, data);
    return file;
  }
};

/// A PNG from zlib alone.
struct Png {
  enum : std::uint8_t { kGrey = 0, kColour = 2, kPalette = 3, kGreyAlpha = 4, kColourAlpha = 6 };
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::uint8_t bits = 8;
  std::uint8_t colour = kGrey;
  Bytes rows = {};  ///< each after the number of its filter, 0 for none
  Bytes transparency = {};
  Bytes palette = {};
  std::uint8_t interlaced = 0;

  [[nodiscard]] Bytes bytes() const;
};

inline Bytes text(std::string_view characters) {
  return {characters.begin(), characters.end()};
}

/// Samples of 8 or 16 bits, rows from the top: grey, or red, green, blue.
struct Raster {
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::uint32_t channels = 1;
  std::uint32_t bits = 8;
  std::vector<std::uint16_t> samples;
};

/// A colour picture with smooth and rough parts.
inline Raster colour_picture(std::uint32_t height = 48, std::uint32_t width = 64) {
  Raster picture{height, width, 3, 8, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      for (const std::uint32_t sample : {(x / 8 + y / 8) % 2 * 200, x * y, 3 * x + y}) {
        picture.samples.push_back(static_cast<std::uint16_t>(sample % 256));
      }
    }
  }
  return picture;
}

/// The formula of docs/method.md, for pixel `i`.
inline int grey_at(const Raster& colours, std::size_t i) {
  const std::uint16_t* rgb = &colours.samples[3 * i];
  return (299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2] + 500) / 1000;
}

/// Two bytes a sample of 16 bits, in either order.
Bytes sample_bytes(const Raster& raster, bool big);

Bytes png_file(const Raster& raster);
Bytes jpeg_file(const Raster& raster, bool progressive = false);
/// \param compression  the value of the file's entry; 5 is LZW
Bytes tiff_file(const Raster& raster, std::uint16_t compression = 5);
/// The raster must be in colour.
Bytes bmp_file(const Raster& raster);
Bytes ppm_file(const Raster& raster);

/// The pixels of a colour file, decoded by libjpeg without our reader.
Raster colours_of_jpeg(const Bytes& file);

/// A BMP of 5 x 3 pixels with a palette of the grey levels 0, 10, 20 and 30, as run lengths. From
/// the bottom: 1 1 1 2 3; jumps with a 2 in the middle; 3 3 3 3 3.
inline Bytes packed_bmp() {
  const Bytes palette = numbers({0, 0x0A0A0A, 0x141414, 0x1E1E1E}, 4);
  const Bytes runs = {3, 1, 1, 2, 1, 3, 0, 0, 0, 2, 2, 0, 1, 2, 0, 0, 5, 3, 0, 1};
  Bytes file = Bmp{5, 3, 8, runs, palette, 1, {}}.bytes();
  file[46] = 4;  // entries of the palette
  return file;
}

/// A GIF of 2 x 2 pixels, whose four colours are the grey levels 0, 10, 20 and 30. It has the
/// pictures 1 2 / 3 0 and, if there are two, 3 3 / 3 3.
/// \param transparent  the colour that is transparent; negative: none
inline Bytes gif_file(int pictures = 1, int transparent = -1) {
  // Codes of three bits, lowest first: clear, pixels, clear, pixels, end.
  const auto picture = [](std::initializer_list<std::uint32_t> pixels) {
    constexpr std::uint32_t kClear = 4;
    constexpr std::uint32_t kEnd = 5;
    std::uint32_t codes = 0;
    unsigned shift = 0;
    const auto put = [&](std::uint32_t code) { codes |= code << std::exchange(shift, shift + 3); };
    for (const std::uint32_t pixel : pixels) {
      if (shift == 0 || shift == 9) put(kClear);
      put(pixel);
    }
    put(kEnd);
    Bytes block = hex("2c0000000002000200000203");
    append(block, number(codes, 3));
    block.push_back(0);
    return block;
  };
  Bytes file = text("GIF89a");
  append(file, hex("02000200810000"));
  append(file, hex("0000000a0a0a1414141e1e1e"));
  if (transparent >= 0) {
    append(file, hex("21f904010000"));
    append(file, number(static_cast<std::uint64_t>(transparent), 1));
    file.push_back(0);
  }
  append(file, picture({1, 2, 3, 0}));
  for (int i = 1; i < pictures; ++i) append(file, picture({3, 3, 3, 3}));
  file.push_back(0x3B);
  return file;
}

/// Writes the bytes to a file and reads it as a picture.
inline GreyImage read_bytes(const Bytes& bytes) {
  static const TempFolder folder;
  const auto path = folder.path() / "picture";
  std::ofstream(path, std::ios::binary) << text_of(bytes);
  return engine::read_grey_image(path);
}

/// The first row's pixels.
inline std::vector<int> first_row(const Bytes& bytes) {
  const GreyImage image = read_bytes(bytes);
  return {image.row(0).begin(), image.row(0).end()};
}

/// One valid picture of each kind, for tests that damage them.
std::map<std::string, Bytes> one_of_each_kind();

}  // namespace touchtrial::samples
