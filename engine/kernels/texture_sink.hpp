/// \file Writes the rows of a texture to its plane, and makes the picture from them.
#pragma once

#include "engine/extraction.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/streamed_row.hpp"

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

/// Takes the rows of a texture from top to bottom, and makes their picture while they are in the
/// cache. Writes a plane that is too large for the cache past it, from scratch rows. Sinks for
/// other rows of the same result may work at the same time.
class TextureSink {
 public:
  /// \param result  planes as shape_planes() leaves them. Must outlive the sink.
  explicit TextureSink(Extraction<float>& result);

  /// Where the caller writes row y, `width` samples and no more. The row before it must be
  /// finished.
  [[nodiscard]] float* row(int y) noexcept;
  /// The row that the caller must move between row(y) and finish_row(y).
  [[nodiscard]] std::span<const StreamedRow> waiting() const noexcept {
    return {&waiting_, is_waiting_ ? std::size_t{1} : 0};
  }
  void finish_row(int y);
  /// Call it after the last row.
  void finish();

 private:
  Extraction<float>& result_;
  std::optional<AlignedRows<float>> scratch_;  ///< two rows, of which one waits to be moved
  StreamedRow waiting_;
  bool is_waiting_ = false;
};

/// Gives texture and picture the shape height x width, or 0 x 0 if the picture is not wanted. A
/// plane that has its shape already is not allocated again.
void shape_planes(int height, int width, const WantedPlanes& wanted, Extraction<float>& result);

/// Fills the planes for a texture of zeros.
void fill_flat(Extraction<float>& result);

}  // namespace touchtrial::engine
