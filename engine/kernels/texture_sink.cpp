#include "engine/kernels/texture_sink.hpp"

#include "engine/kernels/field_rows.hpp"
#include "engine/kernels/reshaped.hpp"

namespace touchtrial {
namespace {

constexpr int kTextureRows = 3;
constexpr std::size_t kForceX = 3;
constexpr std::size_t kForceY = 4;
constexpr std::size_t kScratchRows = 5;

/// From this size on, planes leave the caches before anyone reads them; measured.
constexpr std::size_t kStreamFromBytes = std::size_t{32} << 20;

}  // namespace

TextureSink::TextureSink(int height, int width, const WantedPlanes& wanted,
                         Extraction<float>& result)
    : height_(height), width_(width), result_(result) {
  reshape(result.texture, height, width);
  reshape_if(wanted.picture, result.picture, height, width);
  reshape_if(wanted.force, result.force.x, height, width);
  reshape_if(wanted.force, result.force.y, height, width);
  const std::size_t samples = result.texture.size() + 2 * result.force.x.size();
  if (samples * sizeof(float) >= kStreamFromBytes) {
    scratch_.emplace(kScratchRows, static_cast<std::size_t>(width), 0);
  }
}

float* TextureSink::row(int y) noexcept {
  return scratch_ ? scratch_->row(static_cast<std::size_t>(y % kTextureRows))
                  : result_.texture.row(y).data();
}

void TextureSink::finish_row(int y) {
  if (scratch_) stream_row(row(y), width_, result_.texture.row(y).data());
  if (!result_.picture.empty()) picture_row(row(y), width_, result_.picture.row(y).data());
  if (!result_.force.x.empty() && y > 0) make_force(y - 1);
}

void TextureSink::finish() {
  if (!result_.force.x.empty()) make_force(height_ - 1);
  if (scratch_) finish_streams();
}

/// A constant added to the texture would add nothing to its force: 128 need not be.
void TextureSink::make_force(int y) {
  const SurfaceRows rows{y > 0 ? row(y - 1) : nullptr, row(y),
                         y + 1 < height_ ? row(y + 1) : nullptr};
  float* const to_x = result_.force.x.row(y).data();
  float* const to_y = result_.force.y.row(y).data();
  if (!scratch_) {
    force_row(rows, width_, to_x, to_y);
    return;
  }
  force_row(rows, width_, scratch_->row(kForceX), scratch_->row(kForceY));
  stream_row(scratch_->row(kForceX), width_, to_x);
  stream_row(scratch_->row(kForceY), width_, to_y);
}

}  // namespace touchtrial
