#include "app/sound/session_sound.hpp"
#include "device/platform/realtime.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "support/realtime_watch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kRateHz = 48000.0;

double rms_of(const std::vector<float>& samples) {
  double power = 0.0;
  for (const float sample : samples) power += static_cast<double>(sample) * sample;
  return std::sqrt(power / static_cast<double>(samples.size()));
}

float peak_of(const std::vector<float>& samples) {
  float peak = 0.0F;
  for (const float sample : samples) peak = std::max(peak, std::abs(sample));
  return peak;
}

/// The power between two of the loop's harmonics, from a sample of them.
double density_at(const std::vector<float>& samples, int first, int last) {
  constexpr int kLooks = 64;
  double power = 0.0;
  for (int look = 0; look < kLooks; ++look) {
    const int harmonic = first + (last - first) * look / kLooks;
    const double step = 2.0 * std::numbers::pi * harmonic / static_cast<double>(samples.size());
    double even = 0.0;
    double odd = 0.0;
    // A rotating pair instead of a sine and a cosine for each sample.
    double c = 1.0;
    double s = 0.0;
    for (const float sample : samples) {
      even += c * sample;
      odd += s * sample;
      const double turned = c * std::cos(step) - s * std::sin(step);
      s = s * std::cos(step) + c * std::sin(step);
      c = turned;
    }
    power += even * even + odd * odd;
  }
  return power / kLooks;
}

std::vector<float> rendered(app::SoundMixer& mixer, std::size_t count) {
  std::vector<float> samples(count);
  mixer.render(samples);
  return samples;
}

TEST_CASE("masking noise has the requested level and mean 0") {
  for (const double level : {-60.0, -30.0, -18.0}) {
    const std::vector<float> noise = app::masking_noise(level, 7);
    CHECK(20.0 * std::log10(rms_of(noise)) == Approx(level).margin(1e-4));
    double sum = 0.0;
    for (const float sample : noise) sum += sample;
    CHECK(std::abs(sum / static_cast<double>(noise.size())) < 1e-6);
  }
}

TEST_CASE("masking noise does not clip at the highest level, and nothing is louder") {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    CHECK(peak_of(app::masking_noise(app::kMaxMaskingDbfs, seed)) < 0.8F);
  }
  CHECK(app::masking_noise(0.0, 1) == app::masking_noise(app::kMaxMaskingDbfs, 1));
}

TEST_CASE("masking noise follows from its seed") {
  CHECK(app::masking_noise(-30.0, 3) == app::masking_noise(-30.0, 3));
  CHECK(app::masking_noise(-30.0, 3) != app::masking_noise(-30.0, 4));
}

TEST_CASE("masking noise falls by three decibels an octave") {
  const std::vector<float> noise = app::masking_noise(-30.0, 1);
  // 96 to 192 Hz and 3.1 to 6.1 kHz at 48 kHz: five octaves apart.
  const double low = density_at(noise, 524, 1048);
  const double high = density_at(noise, 16768, 33536);
  CHECK(10.0 * std::log10(high / low) / 5.0 == Approx(-3.0).margin(0.6));
}

TEST_CASE("noise begins and ends in ramps without a step") {
  app::SoundMixer mixer(kRateHz, std::vector<float>(1000, 0.5F));
  CHECK(peak_of(rendered(mixer, 500)) == 0.0F);
  float before = 0.0F;
  for (const bool on : {true, false}) {
    mixer.set_masking(on);
    const std::vector<float> samples = rendered(mixer, 4800);
    for (const float sample : samples) {
      // 0.5 in 50 ms, and rounding.
      CHECK(std::abs(sample - before) < 0.5F / 2400.0F + 1e-6F);
      before = sample;
    }
    CHECK(before == Approx(on ? 0.5F : 0.0F));
  }
}

TEST_CASE("tones begin and end without a step, and stop by themselves") {
  for (const app::Cue cue : {app::Cue::plane_on, app::Cue::plane_off, app::Cue::too_hard,
                             app::Cue::stopped, app::Cue::first_begins, app::Cue::second_begins,
                             app::Cue::third_begins, app::Cue::interval_over}) {
    app::SoundMixer mixer(kRateHz, {});
    mixer.play(cue);
    const std::vector<float> samples = rendered(mixer, 48000);
    CHECK(peak_of(samples) > 0.05F);
    CHECK(samples.front() == 0.0F);
    CHECK(std::abs(samples.back()) == 0.0F);
    float step = 0.0F;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      step = std::max(step, std::abs(samples[i] - samples[i - 1]));
    }
    // The steepest slope of a 1 kHz sine with its amplitude.
    const float amplitude = peak_of(samples) > 0.07F ? 0.12F : 0.06F;
    CHECK(step < amplitude * 2.0F * 3.1416F * 1000.0F / 48000.0F + 1e-4F);
  }
}

TEST_CASE("a tone that still sounds is not restarted, and can be played again later") {
  app::SoundMixer mixer(kRateHz, {});
  mixer.play(app::Cue::too_hard);
  std::ignore = rendered(mixer, 6000);
  mixer.play(app::Cue::too_hard);
  const std::vector<float> rest = rendered(mixer, 12000);
  CHECK(peak_of({rest.begin() + 6000, rest.end()}) == 0.0F);
  mixer.play(app::Cue::too_hard);
  CHECK(peak_of(rendered(mixer, 6000)) > 0.05F);
}

std::vector<float> samples_of(app::Cue cue) {
  app::SoundMixer mixer(kRateHz, {});
  mixer.play(cue);
  return rendered(mixer, 48000);
}

/// Sounds between silences of at least 50 ms, in seconds.
std::vector<double> lengths_of_sounds(const std::vector<float>& samples) {
  std::vector<double> lengths;
  std::size_t begin = 0;
  std::size_t last = 0;
  bool sounds = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i] != 0.0F) {
      if (!sounds) begin = i;
      sounds = true;
      last = i;
    } else if (sounds && i - last > 2400) {
      lengths.push_back(static_cast<double>(last - begin) / kRateHz);
      sounds = false;
    }
  }
  return lengths;
}

TEST_CASE("the number of an interval is as many short tones, and its end is one long tone") {
  const std::vector<std::pair<app::Cue, std::size_t>> begins = {
      {app::Cue::first_begins, 1}, {app::Cue::second_begins, 2}, {app::Cue::third_begins, 3}};
  for (const auto& [cue, number] : begins) {
    const std::vector<double> lengths = lengths_of_sounds(samples_of(cue));
    CHECK(lengths.size() == number);
    for (const double length : lengths) CHECK(length == Approx(0.12).margin(0.002));
  }
  const std::vector<double> end = lengths_of_sounds(samples_of(app::Cue::interval_over));
  REQUIRE(end.size() == 1);
  CHECK(end.front() > 3.0 * 0.12);
}

double db_of(double mean_square) {
  return 10.0 * std::log10(mean_square);
}

/// The level of a tone between its ramps, dBFS.
double level_of(app::Cue cue) {
  const std::vector<float> samples = samples_of(cue);
  const double rms = rms_of({samples.begin() + 480, samples.begin() + 480 + 4320});  // 90 ms
  return db_of(rms * rms);
}

TEST_CASE("the marks of intervals stand out from the masking noise") {
  // The third of an octave around 1 kHz: 891 to 1122 Hz are these harmonics of the loop.
  constexpr int kFirst = 4866;
  constexpr int kLast = 6127;
  const auto third_of_octave = [](const std::vector<float>& noise) {
    const auto count = static_cast<double>(noise.size());
    return db_of(2.0 * density_at(noise, kFirst, kLast) * (kLast - kFirst) / (count * count));
  };
  const std::vector<float> usual = app::masking_noise(study::MaskingPlan{}.level_dbfs, 3);
  const std::vector<float> loudest = app::masking_noise(app::kMaxMaskingDbfs, 3);
  for (const app::Cue mark : {app::Cue::first_begins, app::Cue::second_begins,
                              app::Cue::third_begins, app::Cue::interval_over}) {
    const double level = level_of(mark);
    CHECK(level == Approx(-21.4).margin(0.1));
    CHECK(level - db_of(std::pow(rms_of(usual), 2)) == Approx(8.6).margin(0.2));
    CHECK(level - third_of_octave(usual) == Approx(25.0).margin(2.0));
    CHECK(level - third_of_octave(loudest) == Approx(13.0).margin(2.0));
    CHECK(level - level_of(app::Cue::too_hard) == Approx(6.0).margin(0.1));
  }
}

TEST_CASE("tones that sound together over the loudest noise stay within full scale") {
  using Cues = std::vector<app::Cue>;
  const Cues together = GENERATE(Cues{app::Cue::third_begins, app::Cue::too_hard},
                                 Cues{app::Cue::plane_on, app::Cue::plane_off, app::Cue::too_hard});
  app::SoundMixer mixer(kRateHz, app::masking_noise(0.0, 5));
  mixer.set_masking(true);
  for (int i = 0; i < 20; ++i) {
    for (const app::Cue cue : together) mixer.play(cue);
    CHECK(peak_of(rendered(mixer, 36000)) < 1.0F);
  }
}

TEST_CASE("rendering sound allocates and locks nothing") {
  app::SoundMixer mixer(kRateHz, app::masking_noise(-30.0, 5));
  std::vector<float> samples(4800);
  std::ignore = take_realtime_offences();
  {
    const device::RealtimeRegion region;
    mixer.set_masking(true);
    mixer.play(app::Cue::plane_on);
    mixer.render(samples);
    mixer.play(app::Cue::too_hard);
    mixer.render(samples);
  }
  CHECK(take_realtime_offences() == RealtimeOffences{});
}

/// While it lives, ALSA reads its configuration from here.
class AlsaConfiguration {
 public:
  explicit AlsaConfiguration(const std::string& text) {
    std::ofstream(folder_.path() / "asoundrc") << text;
  }

 private:
  TempFolder folder_;
  EnvironmentVariable variable_{"ALSA_CONFIG_PATH", (folder_.path() / "asoundrc").c_str()};
};

TEST_CASE("without a sound card a session is silent, says why, and records it once") {
  const AlsaConfiguration nothing("pcm.!default { type hw card 99 }\n");
  app::SessionSound sound(study::MaskingPlan{}, 1);
  sound.play(app::Cue::plane_on);
  CHECK(sound.failure_reason().find("sound: ") == 0);
  const auto record = sound.next_record_entry();
  REQUIRE(record);
  CHECK(record->kind == session::ExperimenterRequest::Kind::deviation);
  CHECK(record->code == "no-masking-noise");
  CHECK_FALSE(sound.next_record_entry());
}

TEST_CASE("a study without masking noise records nothing about it") {
  const AlsaConfiguration nothing("pcm.!default { type hw card 99 }\n");
  app::SessionSound sound({.wanted = false}, 1);
  CHECK_FALSE(sound.next_record_entry());
}

/// The samples that the sound card has received so far, from the file.
std::vector<float> samples_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<float> samples;
  float sample = 0.0F;
  while (stream.read(reinterpret_cast<char*>(&sample), sizeof sample)) samples.push_back(sample);
  return samples;
}

TEST_CASE("the mixed samples arrive at the sound card unchanged") {
  const TempFolder folder;
  const std::filesystem::path file = folder.path() / "played.raw";
  const AlsaConfiguration to_file("pcm.!default { type file\n slave.pcm { type null }\n file \"" +
                                  file.string() + "\"\n format \"raw\" }\n");
  constexpr std::int64_t kCount = 24000;
  app::SoundMixer mixer(kRateHz, app::masking_noise(-30.0, 2));
  mixer.set_masking(true);
  mixer.play(app::Cue::plane_on);
  {
    const app::SoundCard card(mixer);
    CHECK(card.is_playing());
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (mixer.rendered_samples() < 4 * kCount && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  app::SoundMixer twin(kRateHz, app::masking_noise(-30.0, 2));
  twin.set_masking(true);
  twin.play(app::Cue::plane_on);
  const std::vector<float> played = samples_in(file);
  const std::vector<float> expected = rendered(twin, kCount);
  // The sound card's buffer begins with silence.
  REQUIRE(expected.front() != 0.0F);
  const auto first =
      std::find_if(played.begin(), played.end(), [](float sample) { return sample != 0.0F; });
  REQUIRE(played.end() - first >= kCount);
  CHECK(std::equal(expected.begin(), expected.end(), first));
}

}  // namespace
}  // namespace touchtrial
