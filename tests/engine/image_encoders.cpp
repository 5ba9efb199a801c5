// Encoders for the tests: PNG with zlib alone, JPEG with libjpeg, TIFF with libtiff.
#include "core/files.hpp"
#include "engine/image_samples.hpp"

#include <cstdlib>
#include <memory>

#include <jpeglib.h>
#include <tiffio.h>
#include <zlib.h>

namespace touchtrial::samples {
namespace {

Bytes png_chunk(std::string_view type, const Bytes& data) {
  Bytes named = text(type);
  append(named, data);
  Bytes chunk = number(data.size(), 4, true);
  append(chunk, named);
  append(chunk, number(::crc32(0, named.data(), static_cast<uInt>(named.size())), 4, true));
  return chunk;
}

Bytes deflated(const Bytes& bytes) {
  uLongf size = ::compressBound(bytes.size());
  Bytes packed(size);
  ::compress(packed.data(), &size, bytes.data(), bytes.size());
  packed.resize(size);
  return packed;
}

}  // namespace

Bytes sample_bytes(const Raster& raster, bool big) {
  Bytes bytes;
  for (const std::uint16_t sample : raster.samples) {
    append(bytes, number(sample, raster.bits / 8U, big));
  }
  return bytes;
}

Bytes Png::bytes() const {
  Bytes header = numbers({width, height}, 4, true);
  append(header, {bits, colour, 0, 0, interlaced});
  Bytes file = hex("89504e470d0a1a0a");
  append(file, png_chunk("IHDR", header));
  if (!palette.empty()) append(file, png_chunk("PLTE", palette));
  if (!transparency.empty()) append(file, png_chunk("tRNS", transparency));
  append(file, png_chunk("IDAT", deflated(rows)));
  append(file, png_chunk("IEND", {}));
  return file;
}

Bytes png_file(const Raster& raster) {
  const Bytes samples = sample_bytes(raster, true);
  const std::size_t row_size = samples.size() / raster.height;
  Png png{raster.width, raster.height, static_cast<std::uint8_t>(raster.bits), Png::kGrey, {}};
  if (raster.channels != 1) png.colour = Png::kColour;
  for (std::size_t y = 0; y < raster.height; ++y) {
    png.rows.push_back(0);  // no filter
    png.rows.insert(png.rows.end(), &samples[y * row_size], &samples[y * row_size] + row_size);
  }
  return png.bytes();
}

Bytes jpeg_file(const Raster& raster, bool progressive) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* start = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &start, &size);
  jpeg.image_width = raster.width;
  jpeg.image_height = raster.height;
  jpeg.input_components = static_cast<int>(raster.channels);
  jpeg.in_color_space = raster.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  Bytes samples = sample_bytes(raster, false);
  for (std::size_t y = 0; y < raster.height; ++y) {
    JSAMPROW row = &samples[y * samples.size() / raster.height];
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const Bytes file(start, start + size);
  std::free(start);
  return file;
}

Raster colours_of_jpeg(const Bytes& file) {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, file.data(), file.size());
  jpeg_read_header(&jpeg, TRUE);
  jpeg.out_color_space = JCS_RGB;
  jpeg_start_decompress(&jpeg);
  Raster raster{jpeg.output_height, jpeg.output_width, 3, 8, {}};
  Bytes samples(3 * raster.width);
  for (std::uint32_t y = 0; y < raster.height; ++y) {
    JSAMPROW row = samples.data();
    jpeg_read_scanlines(&jpeg, &row, 1);
    raster.samples.insert(raster.samples.end(), samples.begin(), samples.end());
  }
  jpeg_finish_decompress(&jpeg);
  jpeg_destroy_decompress(&jpeg);
  return raster;
}

Bytes tiff_file(const Raster& raster, std::uint16_t compression) {
  const TempFolder folder;
  const auto path = folder.path() / "picture.tif";
  {
    const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(TIFFOpen(path.c_str(), "wl"), TIFFClose);
    const auto set = [&](std::uint32_t tag, auto value) { TIFFSetField(tiff.get(), tag, value); };
    set(TIFFTAG_IMAGEWIDTH, raster.width);
    set(TIFFTAG_IMAGELENGTH, raster.height);
    set(TIFFTAG_BITSPERSAMPLE, raster.bits);
    set(TIFFTAG_SAMPLESPERPIXEL, raster.channels);
    set(TIFFTAG_PHOTOMETRIC, raster.channels == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    set(TIFFTAG_COMPRESSION, compression);
    set(TIFFTAG_ROWSPERSTRIP, 16U);
    Bytes samples = sample_bytes(raster, false);
    for (std::uint32_t y = 0; y < raster.height; ++y) {
      TIFFWriteScanline(tiff.get(), &samples[y * samples.size() / raster.height], y, 0);
    }
  }
  return read_file(path);
}

Bytes bmp_file(const Raster& raster) {
  Bytes rows;
  for (std::size_t i = 0; i < raster.samples.size(); i += 3) {
    for (const std::size_t channel : {2U, 1U, 0U}) {
      rows.push_back(static_cast<std::uint8_t>(raster.samples[i + channel]));
    }
    if ((i / 3 + 1) % raster.width == 0) rows.resize((rows.size() + 3) / 4 * 4);
  }
  return Bmp{static_cast<std::int32_t>(raster.width),
             -static_cast<std::int32_t>(raster.height),
             24,
             rows,
             {},
             0,
             {}}
      .bytes();
}

Bytes ppm_file(const Raster& raster) {
  Bytes file = text((raster.channels == 1 ? "P5 " : "P6 ") + std::to_string(raster.width) + " " +
                    std::to_string(raster.height) + (raster.bits == 8 ? " 255\n" : " 65535\n"));
  append(file, sample_bytes(raster, true));
  return file;
}

std::map<std::string, Bytes> one_of_each_kind() {
  const Raster colour = colour_picture(12, 15);
  return {{"png", png_file(colour)},
          {"jpeg", jpeg_file(colour)},
          {"progressive jpeg", jpeg_file(colour, true)},
          {"tiff", tiff_file(colour)},
          {"plain tiff", Tiff(5, 3, Bytes(15, 9)).bytes()},
          {"bmp", bmp_file(colour)},
          {"packed bmp", packed_bmp()},
          {"gif", gif_file()},
          {"pgm", text("P5 2 2 255\nabcd")},
          {"ppm", text("P6 2 1 65535\nabcdefghijkl")}};
}

}  // namespace touchtrial::samples
