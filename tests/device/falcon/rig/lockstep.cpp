#include "device/falcon/rig/lockstep.hpp"

#include <condition_variable>
#include <mutex>

namespace touchtrial::device::falcon {

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
    state_->now = time;
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
