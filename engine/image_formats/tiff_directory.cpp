#include "engine/image_formats/tiff_directory.hpp"

#include <algorithm>

namespace touchtrial::engine {
namespace {

constexpr std::size_t kEntrySize = 12;
constexpr std::uint32_t kAscii = 2;
constexpr std::uint32_t kLong = 4;
constexpr std::uint32_t kRational = 5;

/// Bytes of one value; 0 for unsupported types.
std::size_t size_of_type(std::uint32_t type) {
  switch (type) {
    case 1:
      return 1;  // BYTE
    case 3:
      return 2;  // SHORT
    case kLong:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

TiffDirectory::TiffDirectory(ByteView file, std::size_t offset)
    : file_(file),
      order_(bytes_at(file, 0, 2)[0] == std::uint8_t{'M'} ? ByteOrder::big : ByteOrder::little),
      start_(offset == 0 ? number_at(file, 4, 4, order_) : offset) {
  const std::size_t count = number_at(file, start_, 2, order_);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = start_ + 2 + i * kEntrySize;
    const auto tag =
        static_cast<TiffTag>(number_at(bytes_at(file, entry, kEntrySize), 0, 2, order_));
    const bool is_new = entries_.emplace(tag, entry).second;
    // Readers differ in which duplicate they use, so such a file is ambiguous.
    if (!is_new) throw_truncated_image();
  }
  next_ = number_at(file, start_ + 2 + count * kEntrySize, 4, order_);
}

bool TiffDirectory::is_reduced() const {
  constexpr std::uint32_t kReducedFlag = 1;
  constexpr std::uint32_t kOldReduced = 2;
  return (value(TiffTag::new_subfile_type, 0) & kReducedFlag) != 0 ||
         value(TiffTag::subfile_type, 0) == kOldReduced;
}

ByteView TiffDirectory::data(std::size_t entry_offset, std::size_t size) const {
  const std::size_t count = number_at(file_, entry_offset + 4, 4, order_);
  const bool is_inline = size * count <= 4;
  return bytes_at(file_,
                  is_inline ? entry_offset + 8 : number_at(file_, entry_offset + 8, 4, order_),
                  size * count);
}

std::vector<std::uint32_t> TiffDirectory::values(TiffTag tag) const {
  const auto entry = entries_.find(tag);
  if (entry == entries_.end()) return {};
  const std::size_t entry_offset = entry->second;
  const std::size_t size = size_of_type(number_at(file_, entry_offset + 2, 2, order_));
  const ByteView bytes = data(entry_offset, size);
  std::vector<std::uint32_t> values(size == 0 ? 0 : bytes.size() / size);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = number_at(bytes, i * size, size, order_);
  }
  return values;
}

std::string TiffDirectory::text(TiffTag tag) const {
  const auto entry = entries_.find(tag);
  if (entry == entries_.end() || number_at(file_, entry->second + 2, 2, order_) != kAscii)
    return {};
  std::string text = text_of(data(entry->second, 1));
  std::erase_if(text, [](char c) { return c == '\0' || c == ' '; });
  return text;
}

std::uint32_t TiffDirectory::value(TiffTag tag, std::uint32_t default_value) const {
  const std::vector<std::uint32_t> numbers = values(tag);
  return numbers.empty() ? default_value : numbers.front();
}

std::optional<double> TiffDirectory::fraction(TiffTag tag) const {
  const auto entry = entries_.find(tag);
  if (entry == entries_.end()) return std::nullopt;
  const std::size_t entry_offset = entry->second;
  if (number_at(file_, entry_offset + 2, 2, order_) != kRational) return std::nullopt;
  const std::size_t offset = number_at(file_, entry_offset + 8, 4, order_);
  const std::uint32_t numerator = number_at(file_, offset, 4, order_);
  const std::uint32_t denominator = number_at(file_, offset + 4, 4, order_);
  if (denominator == 0) return std::nullopt;
  return static_cast<double>(numerator) / denominator;
}

TiffPictures pictures_of_tiff(ByteView file) {
  constexpr int kMaxDirectories = 10'000;  // ends a cyclic chain
  TiffDirectory directory(file);
  TiffPictures pictures{directory.start(), 0};
  try {
    for (int i = 0; i < kMaxDirectories; ++i) {
      if (!directory.is_reduced() && pictures.count++ == 0) pictures.first = directory.start();
      if (directory.next() == 0) break;
      directory = TiffDirectory(file, directory.next());
    }
  } catch (const ImageFault&) {
    // The directories before the damaged one are valid.
  }
  pictures.count = std::max(pictures.count, 1);
  return pictures;
}

}  // namespace touchtrial::engine
