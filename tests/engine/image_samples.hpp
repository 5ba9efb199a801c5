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
#include <vector>

#include <opencv2/imgcodecs.hpp>

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

inline Bytes text(std::string_view characters) {
  return {characters.begin(), characters.end()};
}

/// A colour picture with smooth and rough parts.
inline cv::Mat colour_picture(int height = 48, int width = 64) {
  cv::Mat picture(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      picture.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>((3 * x + y) % 256),
                                     static_cast<std::uint8_t>((x * y) % 256),
                                     static_cast<std::uint8_t>((x / 8 + y / 8) % 2 * 200)};
    }
  }
  return picture;
}

inline Bytes encoded(const std::string& extension, const cv::Mat& picture,
                     const std::vector<int>& options = {}) {
  Bytes bytes;
  cv::imencode(extension, picture, bytes, options);
  return bytes;
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

/// One whole picture of each kind, for tests that cut and change them.
inline std::map<std::string, Bytes> one_of_each_kind() {
  const cv::Mat colour = colour_picture(12, 15);
  return {{"png", encoded(".png", colour)},
          {"jpeg", encoded(".jpg", colour)},
          {"progressive jpeg", encoded(".jpg", colour, {cv::IMWRITE_JPEG_PROGRESSIVE, 1})},
          {"tiff", encoded(".tif", colour)},
          {"plain tiff", Tiff(5, 3, Bytes(15, 9)).bytes()},
          {"bmp", encoded(".bmp", colour)},
          {"pgm", text("P5 2 2 255\nabcd")},
          {"ppm", text("P6 2 1 65535\nabcdefghijkl")}};
}

}  // namespace touchtrial::samples
