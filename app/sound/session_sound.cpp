#include "app/sound/session_sound.hpp"

#include "app/sound/masking_noise.hpp"
#include "core/errors.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

session::ExperimenterRequest no_masking(const std::string& why) {
  return {session::ExperimenterRequest::Kind::deviation, why, "no-masking-noise"};
}

}  // namespace

SessionSound::SessionSound(const design::MaskingPlan& plan, std::uint64_t seed)
    : plan_(plan),
      mixer_(SoundCard::kRateHz,
             plan.wanted ? masking_noise(plan.level_dbfs, seed) : std::vector<float>{}) {
  mixer_.mask(plan.wanted);
  try {
    card_.emplace(mixer_);
  } catch (const DeviceError& error) {
    trouble_ = error.what();
  }
}

void SessionSound::tone(Cue cue) noexcept {
  mixer_.tone(cue);
}

std::optional<session::ExperimenterRequest> SessionSound::to_record() {
  if (!plan_.wanted) return std::nullopt;
  if (!recorded_) {
    recorded_ = true;
    if (!card_) return no_masking(trouble_);
    return session::ExperimenterRequest{
        session::ExperimenterRequest::Kind::note,
        fmt::format("masking noise at {:.1f} dBFS rms",
                    std::min(plan_.level_dbfs, kHighestMaskingDbfs)),
        ""};
  }
  if (!card_ || loss_recorded_ || card_->plays()) return std::nullopt;
  loss_recorded_ = true;
  trouble_ = "sound: the output is gone; connect the headphones again before the next session";
  return no_masking(trouble_);
}

}  // namespace touchtrial::app
