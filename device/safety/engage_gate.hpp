/// \file Link of the safety chain: no force starts with a blow.
#pragma once

namespace touchtrial::device {

/// Opens once the computed force is small, that is, while the hand is off the plane or only just on
/// it; then it stays open until it is closed.
class EngageGate {
 public:
  /// \param engage_force_n  >= 0; infinity: opens at once
  explicit EngageGate(double engage_force_n) noexcept
      : squared_n2_(engage_force_n * engage_force_n) {}

  [[nodiscard]] bool is_open() const noexcept { return open_; }
  /// \return whether it is open now
  [[nodiscard]] bool try_open(double force_squared_n2) noexcept {
    open_ = open_ || force_squared_n2 <= squared_n2_;
    return open_;
  }
  void close() noexcept { open_ = false; }

 private:
  double squared_n2_;
  bool open_ = false;
};

}  // namespace touchtrial::device
