#include "engine/kernels/texture_sink.hpp"

#include <algorithm>
#include <cstdint>

#include <hwy/cache_control.h>

namespace touchtrial::engine {
namespace {

/// From these sizes on it pays to write past the caches. For three planes it pays long before they
/// fill the second-level cache, because they would displace more useful data. Measured; see
/// docs/decisions/0011.
constexpr std::size_t kStreamTextureFromBytes = std::size_t{3} << 19;
constexpr std::size_t kStreamForceFromBytes = std::size_t{1} << 18;

}  // namespace

TextureSink::TextureSink(int height, int width, const WantedPlanes& wanted,
                         Extraction<float>& result)
    : height_(height), width_(width), result_(result) {
  reshape(result.texture, height, width);
  reshape_if(wanted.picture, result.picture, height, width);
  reshape_if(wanted.force, result.force.x, height, width);
  reshape_if(wanted.force, result.force.y, height, width);
  const std::size_t samples = result.texture.size() + 2 * result.force.x.size();
  past_caches_ =
      samples * sizeof(float) >= (wanted.force ? kStreamForceFromBytes : kStreamTextureFromBytes);
  if (past_caches_ || wanted.force) scratch_.emplace(2, static_cast<std::size_t>(width), 0);
  if (wanted.force) force_.emplace(width);
}

float* TextureSink::row(int y) noexcept {
  if (force_) return force_->next_surface();
  return past_caches_ ? scratch_->row(static_cast<std::size_t>(y % 2))
                      : result_.texture.row(y).data();
}

void TextureSink::finish_row(int y) {
  waiting_count_ = 0;
  const float* const texture = row(y);
  if (!result_.picture.empty()) picture_row(texture, width_, result_.picture.row(y).data());
  if (force_) {
    add_force(y);
  } else if (past_caches_) {
    wait(texture, result_.texture.row(y).data());
  }
}

void TextureSink::finish() {
  for (const StreamedRow& row : waiting()) move_row(row);
  if (force_) {
    force_->finish(result_.force.x.row(height_ - 1).data(),
                   result_.force.y.row(height_ - 1).data());
  }
  if (past_caches_) hwy::FlushStream();
}

void TextureSink::fill_flat() {
  std::fill(result_.texture.samples().begin(), result_.texture.samples().end(), 0.0F);
  std::fill(result_.force.x.samples().begin(), result_.force.x.samples().end(), 0.0F);
  std::fill(result_.force.y.samples().begin(), result_.force.y.samples().end(), 0.0F);
  std::fill(result_.picture.samples().begin(), result_.picture.samples().end(), std::uint8_t{128});
}

/// Makes the force of the texture itself: adding 128 would not change it.
void TextureSink::add_force(int y) {
  const float* const texture = row(y);
  float* const kept = result_.texture.row(y).data();
  float* const of_x = y > 0 ? result_.force.x.row(y - 1).data() : nullptr;
  float* const of_y = y > 0 ? result_.force.y.row(y - 1).data() : nullptr;
  if (past_caches_ || y == 0) {
    force_->add_row(scratch_->row(0), scratch_->row(1), start_stream(texture, width_, kept));
  } else {
    std::copy_n(texture, width_, kept);
    force_->add_row(of_x, of_y);
  }
  if (past_caches_ && y > 0) {
    wait(scratch_->row(0), of_x);
    wait(scratch_->row(1), of_y);
  }
}

void TextureSink::wait(const float* from, float* to) {
  waiting_[waiting_count_++] = start_stream(from, width_, to);
}

}  // namespace touchtrial::engine
