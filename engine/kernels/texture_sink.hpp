/// \file Where the rows of a texture go: its plane, and what else is wanted of it.
#pragma once

#include "engine/extraction.hpp"
#include "engine/kernels/aligned_rows.hpp"

#include <cstddef>
#include <optional>

namespace touchtrial {

/// Takes the rows of a texture from top to bottom and makes picture and force of them while they
/// are in the cache. Planes too large for it are written past it, from rows of scratch.
class TextureSink {
 public:
  /// \param result  its planes get the shape height x width, or 0 x 0 if they are not wanted;
  ///   nothing is allocated where they have it already. Must outlive this.
  TextureSink(int height, int width, const WantedPlanes& wanted, Extraction<float>& result);

  /// Where row y is to be written; the rows before it must have been finished.
  [[nodiscard]] float* row(int y) noexcept;
  void finish_row(int y);
  /// After the last row.
  void finish();

 private:
  void make_force(int y);

  int height_;
  int width_;
  Extraction<float>& result_;
  std::optional<AlignedRows<float>> scratch_;  // three rows of texture, two of force
};

}  // namespace touchtrial
