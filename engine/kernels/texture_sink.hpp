/// \file Writes the rows of a texture to its plane, and makes picture and force from them.
#pragma once

#include "engine/extraction.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/field_rows.hpp"
#include "engine/kernels/streamed_row.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace touchtrial::engine {

/// Gives the plane a shape. If it has another one, its samples become 0; otherwise they stay.
template <typename Sample>
void reshape(Plane<Sample>& plane, int height, int width) {
  if (plane.height() != height || plane.width() != width) plane = Plane<Sample>(height, width);
}

/// The same if the plane is wanted; otherwise empties it.
template <typename Sample>
void reshape_if(bool wanted, Plane<Sample>& plane, int height, int width) {
  if (wanted) {
    reshape(plane, height, width);
  } else {
    plane = {};
  }
}

/// Takes the rows of a texture from top to bottom, and makes picture and force from them while they
/// are in the cache. Writes planes that are too large for the cache past it, from scratch rows.
class TextureSink {
 public:
  /// \param result  its planes get the shape height x width, or 0 x 0 if they are not wanted; a
  ///   plane that has its shape already is not allocated again. Must outlive the sink.
  TextureSink(int height, int width, const WantedPlanes& wanted, Extraction<float>& result);

  /// Where the caller writes row y, `width` samples and no more. The rows before it must be
  /// finished.
  [[nodiscard]] float* row(int y) noexcept;
  /// The rows that the caller must move between row(y) and finish_row(y).
  [[nodiscard]] std::span<const StreamedRow> waiting() const noexcept {
    return {waiting_.data(), waiting_count_};
  }
  void finish_row(int y);
  /// Call it after the last row.
  void finish();

  /// Fills all planes for a texture of zeros. Call it instead of writing rows.
  void fill_flat();

 private:
  void add_force(int y);
  void wait(const float* from, float* to);

  int height_;
  int width_;
  Extraction<float>& result_;
  bool past_caches_;
  std::optional<ForceRows> force_;             // if force is wanted
  std::optional<AlignedRows<float>> scratch_;  // rows to be moved: two of texture, or force x and y
  std::array<StreamedRow, 2> waiting_;
  std::size_t waiting_count_ = 0;
};

}  // namespace touchtrial::engine
