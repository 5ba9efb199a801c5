// On what was felt, and how it was made.
#include "analysis/report/methods_parts.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "engine/order_map.hpp"
#include "engine/rendering/surface_model.hpp"
#include "study/deviation_codes.hpp"
#include "study/setting_words.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kHashDigits = 16;

/// A device with what was recorded of it.
struct UsedDevice {
  std::string words;
  int sessions = 0;
};

std::string device_phrase(const SessionRecord& session) {
  const record::StationRecord& station = *session.station;
  std::string words = station.model.empty() ? session.row.device : station.model;
  std::vector<std::string> facts;
  if (!station.model.empty()) facts.push_back("driver " + session.row.device);
  if (!station.firmware.empty()) facts.push_back("firmware " + station.firmware);
  if (station.max_force_n > 0.0) {
    facts.push_back(number_text(station.max_force_n) + " N at most");
  }
  const std::string& certificate = station.calibration;
  if (ran_unverified(session)) {
    facts.emplace_back("without a valid certificate of acceptance");
  } else if (!certificate.empty()) {
    facts.push_back("accepted by measurement, certificate " + certificate.substr(0, kHashDigits));
  }
  return facts.empty() ? words : words + " (" + listed(facts) + ")";
}

std::vector<UsedDevice> used_devices(const std::vector<const SessionRecord*>& sessions) {
  std::map<std::string, int> counts;
  for (const SessionRecord* session : sessions) {
    if (session->station) ++counts[device_phrase(*session)];
  }
  std::vector<UsedDevice> devices;
  for (const auto& [words, count] : counts) devices.push_back({words, count});
  return devices;
}

std::string device_sentence(const StudyHead& head,
                            const std::vector<const SessionRecord*>& sessions) {
  if (head.simulated) {
    const std::string device = simulated_devices(head.collection);
    return device.empty() ? "" : "The simulated hands held this device: " + device + ".";
  }
  if (head.collection.visual) {
    return "Textures were shown on a screen and felt with nothing but a mouse.";
  }
  const std::vector<UsedDevice> devices = used_devices(sessions);
  if (devices.empty()) return {};
  if (devices.size() == 1) return "Forces were displayed by this device: " + devices[0].words + ".";
  return "Forces were displayed by these devices: " +
         listed(devices, " and ",
                [](const UsedDevice& one) {
                  return one.words + " in " + counted(one.sessions, "session");
                }) +
         ".";
}

bool is_corrected(const std::array<double, 3>& scale) {
  return scale != std::array<double, 3>{1.0, 1.0, 1.0};
}

/// The laboratory's corrections, if they were the same in all sessions.
std::string corrections_sentence(const std::vector<const SessionRecord*>& sessions) {
  const record::StationRecord* first = nullptr;
  for (const SessionRecord* session : sessions) {
    if (!session->station) continue;
    const record::StationRecord& station = *session->station;
    if (first != nullptr && (station.force_scale != first->force_scale ||
                             station.length_scale != first->length_scale)) {
      return "The laboratory's corrections of force and length differed between sessions.";
    }
    first = &station;
  }
  if (first == nullptr) return {};
  const auto axes = [](const std::array<double, 3>& scale) {
    return listed(scale, " and ", number_text);
  };
  std::vector<std::string> parts;
  if (is_corrected(first->force_scale)) parts.push_back("forces by " + axes(first->force_scale));
  if (is_corrected(first->length_scale)) parts.push_back("lengths by " + axes(first->length_scale));
  if (parts.empty()) return {};
  return "On the device's three axes " + listed(parts, " and ") +
         " were corrected, as the laboratory had measured.";
}

std::string rate_sentence(const StudyHead& head, const std::vector<const SessionRecord*>& sessions,
                          const RecordedStudy& recorded) {
  std::set<int> counted_ones;
  for (const SessionRecord* session : sessions) counted_ones.insert(session->row.session);
  std::vector<double> rates_hz;
  std::vector<double> lateness_us;
  for (const ServoTrial& one : head.collection.servo_trials) {
    if (!counted_ones.contains(one.session)) continue;
    rates_hz.push_back(one.health.rate_hz);
    lateness_us.push_back(one.health.lateness_p99_us);
  }
  if (rates_hz.empty()) {
    if (!recorded.rate_hz) return {};
    return fmt::format("Forces were updated at {} Hz{}.", number_text(*recorded.rate_hz),
                       head.simulated ? " of virtual time" : "");
  }
  const auto [low, high] = std::ranges::minmax(rates_hz);
  const Quartiles lateness = quartiles(std::move(lateness_us));
  std::string nominal =
      recorded.rate_hz ? number_text(*recorded.rate_hz) + " Hz" : std::string("a fixed rate");
  std::set<std::string> schedulings;
  for (const SessionRecord* session : sessions) {
    if (session->station && !session->station->scheduling.empty()) {
      schedulings.insert(session->station->scheduling);
    }
  }
  if (!schedulings.empty()) {
    nominal += " by a thread of its own (scheduling: " + listed(schedulings, " or ") + ")";
  }
  return fmt::format(
      "Forces were updated at {}; the mean rate of a trial was {} to {} Hz as measured, and the "
      "99th percentile of a tick's lateness {} µs in the median trial.",
      nominal, plain_figure(low, 1), plain_figure(high, 1), plain_figure(lateness.median, 0));
}

std::string images_sentence(const Outcomes& outcomes) {
  const std::vector<study::StudyClass>& classes = outcomes.design.classes;
  std::size_t images = 0;
  for (const study::StudyClass& one : classes) images += one.images.size();
  const std::string of = images == 1 ? "one grey-level image (8 bits)"
                                     : fmt::format("{} grey-level images (8 bits)", images);
  const std::string labels = listed(classes, " and ", &study::StudyClass::label);
  if (classes.size() == 1) {
    return fmt::format("Stimuli were made from {} of the texture {}.", of, labels);
  }
  const std::size_t of_first = classes.front().images.size();
  const bool are_even = std::ranges::all_of(
      classes, [of_first](const study::StudyClass& one) { return one.images.size() == of_first; });
  const std::string each =
      are_even ? fmt::format(", {} of each", of_first == 1 ? "one" : std::to_string(of_first)) : "";
  return fmt::format("Stimuli were made from {} of {} textures ({}{}).", of, classes.size(), labels,
                     each);
}

std::string planes_sentence(const Outcomes& outcomes, const RecordedStudy& recorded) {
  const double pitch_mm = outcomes.design.rendering.pitch_mm;
  if (recorded.planes.empty()) {
    return fmt::format("A pixel measured {} mm on the plane.", number_text(pitch_mm));
  }
  std::vector<std::string> sizes;
  for (const PlaneGeometry& plane : recorded.planes) {
    sizes.push_back(fmt::format("{:.4g} mm x {:.4g} mm ({} x {} pixels of {:.4g} mm)",
                                plane.width_mm(), plane.height_mm(), plane.width_px,
                                plane.height_px, plane.pitch_mm));
  }
  return "The textured planes measured " + listed(sizes, " or ") + ".";
}

std::string extraction_sentence(const study::Study& study) {
  const study::SettingFields methods = study::fields_of_methods(study);
  if (methods.size() == 1) {
    return fmt::format("The texture T of an image I was extracted by this method: {}.",
                       methods[0].second);
  }
  return fmt::format("The texture T of an image I was extracted by {} methods: {}.", methods.size(),
                     joined_fields(methods));
}

/// Whether a presented method satisfies a condition.
template <typename Condition>
bool any_method(const study::Study& study, const Condition& condition) {
  const auto presented =
      std::span(study.methods).first(static_cast<std::size_t>(study.presented_methods()));
  return std::ranges::any_of(presented, condition);
}

bool has_method(const study::Study& study, engine::Method method) {
  return any_method(study,
                    [method](const study::StudyMethod& one) { return one.method == method; });
}

/// Whether a fractional method has this mask.
bool has_mask(const study::Study& study, engine::Norm mask) {
  return any_method(study, [mask](const study::StudyMethod& one) {
    return one.norm == mask &&
           (one.method == engine::Method::adaptive || one.method == engine::Method::fixed);
  });
}

/// The formulas of the methods that have parameters K and v.
void say_fractional(const study::Study& study, Paragraph& paragraph) {
  const bool is_adaptive = has_method(study, engine::Method::adaptive);
  if (!is_adaptive && !has_method(study, engine::Method::fixed)) return;
  paragraph.say(
      "The fractional differential was T = Σ |c_k(v)| (I − R_k) over k = 1 .. K, with the "
      "Grünwald–Letnikov weights c_0 = 1, c_k = c_(k−1) (k − 1 − v) / k of the order v, and R_k "
      "the mean of the eight pixels at k steps along rows, columns and diagonals.",
      {Source::hu_song});
  if (has_mask(study, engine::Norm::sum)) {
    paragraph.say(
        "With a mask divided by its sum it was T / P, with P the product of 1 − v / k over k.");
  }
  if (has_mask(study, engine::Norm::none)) {
    paragraph.say(
        "With a plain mask it was T + P (I − mean of I), with P the product of 1 − v / k over k.");
  }
  if (!is_adaptive) return;
  paragraph.say(
      fmt::format("The adaptive order followed from the combined norms S of the gradients (not "
                  "normalised) of the four sub-bands of an orthonormal four-tap Daubechies "
                  "transform, enlarged to the image's size by repetition, with M their maximum "
                  "in the image: v = 0 for S < {0:g}, S / (3 M) + 0.666 for S up to {1:g}, and "
                  "S / (2 M) + 0.499 above.",
                  engine::kFlatBelowCsgv, engine::kSteepAboveCsgv));
}

std::string tv_gabor_sentence(const study::Study& study) {
  if (!has_method(study, engine::Method::tv_gabor)) return {};
  return "The TV-Gabor decomposition split I into a cartoon u and the texture T = I − u, which "
         "minimised TV(u) + (λ / 2) ⟨T, K T⟩ with the inverse K of the kernel's spectrum: the sum "
         "of the power spectra of even Gabor patches (11 x 11 pixels, standard deviation 2, less "
         "their means), over its maximum.";
}

std::string control_sentence(const study::Study& study) {
  for (int i = 0; i < study.presented_methods(); ++i) {
    if (study.methods[static_cast<std::size_t>(i)].control == engine::Control::none) continue;
    return "Phases of controls were those of white noise, drawn anew for each stimulus; mean, rms "
           "and the amplitude of each frequency stayed the same.";
  }
  return {};
}

/// How the stylus touches the plane, and what lies between pixels and beyond the plane.
std::string contact_sentence(const engine::RenderingOptions& rendering) {
  if (rendering.model == engine::ModelKind::surface) {
    return fmt::format(
        "The stylus was a point, in contact while e > 0; beyond the plane's edges the mirrored "
        "texture faded within {:g} mm into the flat wall.",
        engine::kRimMm);
  }
  return fmt::format(
      "The stylus was a point, in contact while {}; places p and distances d were in pixels, and "
      "forces between the centres of pixels were interpolated bilinearly; beyond the plane's edges "
      "lay the flat wall.",
      rendering.reference_grey > 0.0 ? "the normal force was above 0" : "it was below the plane");
}

/// What the stiffness budget limits.
std::string budget_sentence(const study::Study& study) {
  const engine::RenderingOptions& rendering = study.rendering;
  if (study.level || rendering.gains) return {};
  return fmt::format(
      "Stiffness was the norm (Frobenius) of the lateral force's Jacobian along the plane{}; the "
      "gradient of the normal force had the same limit.",
      rendering.model == engine::ModelKind::surface
          ? fmt::format(", under a load of {:g} N", engine::kStatedLoadN)
      : rendering.touchdown_ramp_n > 0.0 ? std::string(" and in depth")
                                         : std::string());
}

/// The smallest and the largest number: "0.0117" or "0.0117 to 0.0203".
std::string range_figure(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  const std::string first = fmt::format("{:.3g}", low);
  const std::string last = fmt::format("{:.3g}", high);
  return first == last ? first : first + " to " + last;
}

std::string gain_range(const std::vector<engine::Gains>& gains, double engine::Gains::*gain) {
  std::vector<double> values;
  for (const engine::Gains& one : gains) values.push_back(one.*gain);
  return range_figure(values);
}

std::string strength_sentence(const study::Study& study, const RecordedStudy& recorded) {
  if (recorded.lateral_rms_n.empty()) return {};
  return fmt::format("Over the plane the lateral force of a stimulus had an rms of {} N{}.",
                     range_figure(recorded.lateral_rms_n),
                     study.rendering.model == engine::ModelKind::surface
                         ? fmt::format(" under {:g} N", engine::kStatedLoadN)
                         : std::string());
}

std::string prepared_gains(const study::Study& study, const RecordedStudy& recorded) {
  if (recorded.gains.empty()) return {};
  if (study.rendering.model == engine::ModelKind::surface) {
    return fmt::format(": α = {} mm per grey level",
                       gain_range(recorded.gains, &engine::Gains::height_mm));
  }
  return fmt::format(": k_t = {} N per (grey level per pixel) and c = {} N per grey level",
                     gain_range(recorded.gains, &engine::Gains::tangential_n),
                     gain_range(recorded.gains, &engine::Gains::normal_n));
}

}  // namespace

Cited stimuli_paragraph(const StudyHead& head, const Outcomes& outcomes,
                        const RecordedStudy& recorded) {
  const study::Study& study = outcomes.design;
  const std::vector<const SessionRecord*> sessions = counted_records(head, outcomes);
  Paragraph paragraph;
  paragraph.say(device_sentence(head, sessions));
  paragraph.say(corrections_sentence(sessions));
  paragraph.say(rate_sentence(head, sessions, recorded));
  paragraph.say(images_sentence(outcomes));
  paragraph.say(planes_sentence(outcomes, recorded));
  paragraph.say(extraction_sentence(study));
  say_fractional(study, paragraph);
  paragraph.say(tv_gabor_sentence(study));
  paragraph.say(control_sentence(study));
  paragraph.say("Beyond its borders an image continued as its mirror image.");
  paragraph.say(
      fmt::format("The plane was a virtual wall of {}.", study::wall_words(study.rendering)));
  if (study.rendering.filter_mm > 0.0) {
    paragraph.say(fmt::format("The heights G = 128 + T, not rounded, were smoothed by a {}.",
                              study::filter_words(study.rendering)));
  }
  paragraph.say(
      fmt::format("Heights became forces by this model: {}.", study::force_words(study.rendering)));
  paragraph.say(contact_sentence(study.rendering));
  paragraph.say(fmt::format("The gains were {}{}.", study::gain_words(study),
                            prepared_gains(study, recorded)));
  paragraph.say(budget_sentence(study));
  paragraph.say(strength_sentence(study, recorded));
  if (study.trials.rove_db > 0.0) {
    paragraph.say(fmt::format(
        "The gain of each presentation was drawn from the {} dB below the stimulus's gain.",
        number_text(study.trials.rove_db)));
  }
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
