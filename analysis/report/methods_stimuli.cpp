// The paragraph on apparatus and stimuli.
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
    facts.emplace_back("without a valid acceptance certificate");
  } else if (!certificate.empty()) {
    facts.push_back("accepted by measurement, certificate " + certificate.substr(0, kHashDigits));
  }
  return facts.empty() ? words : words + " (" + listed(facts) + ")";
}

/// The numbers of sessions by device.
std::map<std::string, int> used_devices(const std::vector<const SessionRecord*>& sessions) {
  std::map<std::string, int> devices;
  for (const SessionRecord* session : sessions) {
    if (session->station) ++devices[device_phrase(*session)];
  }
  return devices;
}

std::string device_sentence(const StudyHead& head,
                            const std::vector<const SessionRecord*>& sessions) {
  if (head.simulated) {
    const std::string device = simulated_devices(head.collection);
    return device.empty() ? "" : "The simulated hands held this device: " + device + ".";
  }
  if (head.collection.visual) {
    return "Textures were shown on a screen and explored with a mouse, without forces.";
  }
  const std::map<std::string, int> devices = used_devices(sessions);
  if (devices.empty()) return {};
  if (devices.size() == 1) return "Forces were displayed by " + devices.begin()->first + ".";
  return "Forces were displayed by several devices: " +
         listed(devices, " and ",
                [](const auto& device) {
                  return device.first + " in " + counted(device.second, "session");
                }) +
         ".";
}

bool is_corrected(const std::array<double, 3>& scale) {
  return scale != std::array<double, 3>{1.0, 1.0, 1.0};
}

/// The laboratory's corrections of force and length.
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
  return "Per axis of the device, " + listed(parts, " and ") +
         " were corrected by the laboratory's measurements.";
}

std::string rate_sentence(const StudyHead& head, const std::vector<const SessionRecord*>& sessions,
                          const RecordedStudy& recorded) {
  std::set<int> counted_sessions;
  for (const SessionRecord* session : sessions) counted_sessions.insert(session->row.session);
  std::vector<double> rates_hz;
  std::vector<double> lateness_us;
  for (const ServoTrial& trial : head.collection.servo_trials) {
    if (!counted_sessions.contains(trial.session)) continue;
    rates_hz.push_back(trial.health.rate_hz);
    lateness_us.push_back(trial.health.lateness_p99_us);
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
    nominal += " by a dedicated thread (scheduling: " + listed(schedulings, " or ") + ")";
  }
  return fmt::format(
      "Forces were updated at {}; the measured mean rate of a trial was {} to {} Hz, and the 99th "
      "percentile of a tick's lateness was {} µs in the median trial.",
      nominal, plain_figure(low, 1), plain_figure(high, 1), plain_figure(lateness.median, 0));
}

std::string images_sentence(const Outcomes& outcomes) {
  const std::vector<study::StudyClass>& classes = outcomes.design.classes;
  std::size_t images = 0;
  for (const study::StudyClass& texture : classes) images += texture.images.size();
  const std::string images_words = images == 1
                                       ? "one grey-level image (8 bits)"
                                       : fmt::format("{} grey-level images (8 bits)", images);
  const std::string labels = listed(classes, " and ", &study::StudyClass::label);
  if (classes.size() == 1) {
    return fmt::format("Stimuli were made from {} of the texture {}.", images_words, labels);
  }
  const std::size_t per_first_class = classes.front().images.size();
  const bool are_even =
      std::ranges::all_of(classes, [per_first_class](const study::StudyClass& texture) {
        return texture.images.size() == per_first_class;
      });
  const std::string per_class =
      are_even ? fmt::format(", {} of each",
                             per_first_class == 1 ? "one" : std::to_string(per_first_class))
               : "";
  return fmt::format("Stimuli were made from {} of {} textures ({}{}).", images_words,
                     classes.size(), labels, per_class);
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
  return any_method(study, [method](const study::StudyMethod& study_method) {
    return study_method.method == method;
  });
}

/// Whether a fractional method has this mask.
bool has_mask(const study::Study& study, engine::Norm mask) {
  return any_method(study, [mask](const study::StudyMethod& method) {
    return method.norm == mask &&
           (method.method == engine::Method::adaptive || method.method == engine::Method::fixed);
  });
}

/// The formulas of the fractional methods.
void add_fractional_methods(const study::Study& study, Paragraph& paragraph) {
  const bool is_adaptive = has_method(study, engine::Method::adaptive);
  if (!is_adaptive && !has_method(study, engine::Method::fixed)) return;
  paragraph.add(
      "The fractional differential was T = Σ |c_k(v)| (I − R_k) over k = 1 .. K, with the "
      "Grünwald–Letnikov weights c_0 = 1, c_k = c_(k−1) (k − 1 − v) / k of the order v, and R_k "
      "the mean of the eight pixels k steps away along rows, columns and diagonals.",
      {Source::hu_song});
  if (has_mask(study, engine::Norm::sum)) {
    paragraph.add(
        "With a mask divided by its sum it was T / P, with P the product of 1 − v / k over k.");
  }
  if (has_mask(study, engine::Norm::none)) {
    paragraph.add(
        "With a plain mask it was T + P (I − mean of I), with P the product of 1 − v / k over k.");
  }
  if (!is_adaptive) return;
  paragraph.add(
      fmt::format("The adaptive order followed from the combined norms S of the gradients (not "
                  "normalised) of the four sub-bands of an orthonormal four-tap Daubechies "
                  "transform, enlarged to the image's size by repetition, with M their maximum in "
                  "the image: v = 0 for S < {0:g}, S / (3 M) + 0.666 for S up to {1:g}, and S / (2 "
                  "M) + 0.499 above.",
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
    return "Controls had the phases of white noise, drawn for each stimulus; mean, rms and the "
           "amplitude of each frequency were unchanged.";
  }
  return {};
}

std::string contact_sentence(const engine::RenderingOptions& rendering) {
  if (rendering.model == engine::ModelKind::surface) {
    return fmt::format(
        "The stylus was a point, in contact while e > 0; beyond the plane's edges the mirrored "
        "texture faded into the flat wall within {:g} mm.",
        engine::kRimMm);
  }
  return fmt::format(
      "The stylus was a point, in contact while {}; places p and distances d were in pixels, and "
      "forces between the centres of pixels were interpolated bilinearly; beyond the plane's edges "
      "the wall was flat.",
      rendering.reference_grey > 0.0 ? "the normal force was above 0" : "it was below the plane");
}

std::string budget_sentence(const study::Study& study) {
  const engine::RenderingOptions& rendering = study.rendering;
  if (study.level || rendering.gains) return {};
  return fmt::format(
      "Stiffness was the norm (Frobenius) of the lateral force's Jacobian along the plane{}; the "
      "gradient of the normal force had the same limit.",
      rendering.model == engine::ModelKind::surface
          ? fmt::format(", under a load of {:g} N", engine::kReferenceLoadN)
      : rendering.touchdown_ramp_n > 0.0 ? std::string(" and in depth")
                                         : std::string());
}

/// "0.0117 to 0.0203", or "0.0117" if all values are equal.
std::string range_figure(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  const std::string first = fmt::format("{:.3g}", low);
  const std::string last = fmt::format("{:.3g}", high);
  return first == last ? first : first + " to " + last;
}

std::string gain_range(const std::vector<engine::Gains>& gains, double engine::Gains::*gain) {
  std::vector<double> values;
  for (const engine::Gains& gain_set : gains) values.push_back(gain_set.*gain);
  return range_figure(values);
}

std::string strength_sentence(const study::Study& study, const RecordedStudy& recorded) {
  if (recorded.lateral_rms_n.empty()) return {};
  return fmt::format("Over the plane the lateral force of a stimulus had an rms of {} N{}.",
                     range_figure(recorded.lateral_rms_n),
                     study.rendering.model == engine::ModelKind::surface
                         ? fmt::format(" under {:g} N", engine::kReferenceLoadN)
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

CitedText stimuli_paragraph(const StudyHead& head, const Outcomes& outcomes,
                            const RecordedStudy& recorded) {
  const study::Study& study = outcomes.design;
  const std::vector<const SessionRecord*> sessions = counted_records(head, outcomes);
  Paragraph paragraph;
  paragraph.add(device_sentence(head, sessions));
  paragraph.add(corrections_sentence(sessions));
  paragraph.add(rate_sentence(head, sessions, recorded));
  paragraph.add(images_sentence(outcomes));
  paragraph.add(planes_sentence(outcomes, recorded));
  paragraph.add(extraction_sentence(study));
  add_fractional_methods(study, paragraph);
  paragraph.add(tv_gabor_sentence(study));
  paragraph.add(control_sentence(study));
  paragraph.add("Beyond its borders an image continued as its mirror image.");
  paragraph.add(
      fmt::format("The plane was a virtual wall of {}.", study::wall_words(study.rendering)));
  if (study.rendering.filter_mm > 0.0) {
    paragraph.add(fmt::format("The heights G = 128 + T, not rounded, were smoothed by a {}.",
                              study::filter_words(study.rendering)));
  }
  paragraph.add(fmt::format("Forces were computed from heights by this model: {}.",
                            study::force_words(study.rendering)));
  paragraph.add(contact_sentence(study.rendering));
  paragraph.add(fmt::format("The gains were {}{}.", study::gain_words(study),
                            prepared_gains(study, recorded)));
  paragraph.add(budget_sentence(study));
  paragraph.add(strength_sentence(study, recorded));
  if (study.trials.rove_db > 0.0) {
    paragraph.add(fmt::format(
        "The gain of each presentation was drawn from the {} dB below the stimulus's gain.",
        number_text(study.trials.rove_db)));
  }
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
