#include "engine/kernels/texture_sink.hpp"

#include "engine/kernels/texture_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>

namespace touchtrial::engine {
namespace {

/// From this size on it pays to write past the caches. Measured; see docs/decisions/0011.
constexpr std::size_t kStreamFromBytes = std::size_t{3} << 19;

}  // namespace

TextureSink::TextureSink(Extraction<float>& result) : result_(result) {
  if (result.texture.size() * sizeof(float) < kStreamFromBytes) return;
  scratch_.emplace(2, static_cast<std::size_t>(result.texture.width()), 0);
}

float* TextureSink::row(int y) noexcept {
  return scratch_ ? scratch_->row(static_cast<std::size_t>(y % 2)) : result_.texture.row(y).data();
}

void TextureSink::finish_row(int y) {
  const float* const texture = row(y);
  const int width = result_.texture.width();
  if (!result_.picture.empty()) picture_row(texture, width, result_.picture.row(y).data());
  is_waiting_ = scratch_.has_value();
  if (is_waiting_) waiting_ = start_stream(texture, width, result_.texture.row(y).data());
}

void TextureSink::finish() {
  for (const StreamedRow& row : waiting()) move_row(row);
  is_waiting_ = false;
  if (scratch_) hwy::FlushStream();
}

void shape_planes(int height, int width, const WantedPlanes& wanted, Extraction<float>& result) {
  reshape(result.texture, height, width);
  reshape_if(wanted.picture, result.picture, height, width);
}

void fill_flat(Extraction<float>& result) {
  std::ranges::fill(result.texture.samples(), 0.0F);
  std::ranges::fill(result.picture.samples(), std::uint8_t{128});
}

}  // namespace touchtrial::engine
