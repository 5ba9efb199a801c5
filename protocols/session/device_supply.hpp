/// \file Where a session's device comes from, and how it comes back after a fault.
#pragma once

namespace touchtrial::session {

enum class SupplyState {
  ready,    ///< open, homed and armed: forces may be sent
  not_yet,  ///< something is missing; ask again
  stopped,  ///< somebody gave up: the session is to end
};

/// Whoever has the device. Used between explorations alone, on the session's thread.
class DeviceSupply {
 public:
  virtual ~DeviceSupply() = default;

  /// Takes one step towards a device that is ready: opens it if it was lost, waits for its homing,
  /// asks for consent to arm it again. May block for a moment, not for good.
  [[nodiscard]] virtual SupplyState make_ready() = 0;
  /// The last exploration was interrupted: no force until somebody consents.
  virtual void interrupted() {}
};

/// A device that needs nothing: a simulated hand, made anew for each exploration.
class AlwaysReady final : public DeviceSupply {
 public:
  [[nodiscard]] SupplyState make_ready() override { return SupplyState::ready; }
};

}  // namespace touchtrial::session
