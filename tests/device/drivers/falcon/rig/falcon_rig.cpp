#include "device/drivers/falcon/rig/falcon_rig.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace touchtrial::device::falcon {
namespace {

void throw_if_gone(UsbStatus status) {
  if (status != UsbStatus::ok) throw DeviceError("emulated falcon: unplugged");
}

}  // namespace

void EmulatorTransport::control(FtdiRequest request, std::uint16_t value) {
  throw_if_gone(emulator_.control({0x40, static_cast<std::uint8_t>(request), value, 0}));
}

std::size_t EmulatorTransport::send(std::span<const std::uint8_t> bytes,
                                    std::chrono::milliseconds /*limit*/) {
  throw_if_gone(emulator_.bulk_out(bytes));
  return bytes.size();
}

std::size_t EmulatorTransport::receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                       std::chrono::milliseconds /*limit*/) {
  std::vector<std::uint8_t> bytes;
  throw_if_gone(emulator_.bulk_in(packet.size(), bytes));
  std::ranges::copy(bytes, packet.begin());
  return bytes.size();
}

void EmulatorTransport::start_stream(FtdiStreamSink& sink) {
  if (lost()) throw_if_gone(UsbStatus::gone);
  sink_ = &sink;
}

bool EmulatorTransport::post(std::span<const std::uint8_t> bytes) noexcept {
  if (emulator_.bulk_out(bytes) != UsbStatus::ok) return false;
  if (sink_ != nullptr) sink_->sent();
  return true;
}

void EmulatorTransport::serve(std::chrono::microseconds /*at_most*/) noexcept {
  std::vector<std::uint8_t> bytes;
  if (sink_ != nullptr && emulator_.bulk_in(kUsbPacketSize, bytes) == UsbStatus::ok) {
    sink_->receive(bytes);
  }
}

struct Lockstep::State {
  std::mutex mutex;
  std::condition_variable changed;
  FalconPace::Time now{};
  bool resting = false;
  bool may_go = false;
  bool ended = false;
};

namespace {

class LockstepPace final : public FalconPace {
 public:
  explicit LockstepPace(std::shared_ptr<Lockstep::State> state) : state_(std::move(state)) {}

  [[nodiscard]] Time now() noexcept override {
    const std::lock_guard lock(state_->mutex);
    return state_->now;
  }

  void rest_until(Time time) noexcept override {
    std::unique_lock lock(state_->mutex);
    state_->resting = true;
    state_->changed.notify_all();
    state_->changed.wait(lock, [&] { return state_->may_go || state_->ended; });
    state_->resting = state_->may_go = false;
    state_->now = std::max(state_->now, time);
  }

  void on_wait(Time time) noexcept override {
    const std::lock_guard lock(state_->mutex);
    state_->now += time;
  }

  void end() noexcept override {
    const std::lock_guard lock(state_->mutex);
    state_->ended = true;
    state_->changed.notify_all();
  }

 private:
  std::shared_ptr<Lockstep::State> state_;
};

}  // namespace

Lockstep::Lockstep() : state_(std::make_shared<State>()) {}
Lockstep::~Lockstep() = default;

std::unique_ptr<FalconPace> Lockstep::pace() {
  return std::make_unique<LockstepPace>(state_);
}

FalconPace::Time Lockstep::now() const noexcept {
  const std::lock_guard lock(state_->mutex);
  return state_->now;
}

void Lockstep::step() noexcept {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(lock, [&] { return state_->resting || state_->ended; });
  state_->may_go = true;
  state_->changed.notify_all();
  state_->changed.wait(lock, [&] { return (state_->resting && !state_->may_go) || state_->ended; });
}

void Lockstep::steps(int count) noexcept {
  for (int i = 0; i < count; ++i) step();
}

}  // namespace touchtrial::device::falcon
