#include "study/setting_words.hpp"

#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

namespace touchtrial::study {
namespace {

using engine::ExtractionOptions;
using engine::RenderingOptions;

/// More methods than this are summarised in one line if they differ only in their order.
constexpr std::size_t kMaxListedMethods = 4;

std::string mask_words(const ExtractionOptions& method) {
  static constexpr auto kWords =
      std::to_array<Named<engine::Norm>>({{"additive mask", engine::Norm::additive},
                                          {"mask divided by its sum", engine::Norm::sum},
                                          {"plain mask", engine::Norm::none}});
  return std::string(name_in(kWords, method.norm));
}

std::string gradient_words(engine::Gradient gradient) {
  static constexpr auto kWords =
      std::to_array<Named<engine::Gradient>>({{"Sobel", engine::Gradient::sobel},
                                              {"Prewitt", engine::Gradient::prewitt},
                                              {"central-difference", engine::Gradient::central}});
  return std::string(name_in(kWords, gradient));
}

std::string combination_words(engine::Combine combine) {
  static constexpr auto kWords =
      std::to_array<Named<engine::Combine>>({{"summed", engine::Combine::sum},
                                             {"combined by their l2 norm", engine::Combine::l2},
                                             {"combined by their maximum", engine::Combine::max}});
  return std::string(name_in(kWords, combine));
}

std::string component_words(const engine::GaborComponent& component) {
  return number_text(component.frequency_cycles_per_px) + " cycles per pixel at " +
         number_text(component.direction_deg) + "°";
}

/// Lists the directions after their frequency if all components share it.
std::string kernel_words(const engine::TvGaborOptions& options) {
  if (options.automatic) return "the image's strongest oscillation";
  const auto& components = options.components;
  const double frequency = components.front().frequency_cycles_per_px;
  const bool is_shared =
      std::ranges::all_of(components, [&](const engine::GaborComponent& component) {
        return component.frequency_cycles_per_px == frequency;
      });
  if (!is_shared) return listed(components, " and ", component_words);
  return number_text(frequency) + " cycles per pixel at " +
         listed(components, " and ", [](const engine::GaborComponent& component) {
           return number_text(component.direction_deg) + "°";
         });
}

std::string tv_gabor_words(const engine::TvGaborOptions& options) {
  return fmt::format(
      "TV-Gabor decomposition (λ = {}; Gabor kernel of {}; iterated to a relative gap of {}, in {} "
      "steps at most)",
      number_text(options.lambda), kernel_words(options), number_text(options.gap),
      options.max_steps);
}

/// Whether all methods have a fixed order and differ only in it.
bool differ_only_in_order(std::span<const StudyMethod> methods) {
  return std::ranges::all_of(methods, [&](const StudyMethod& method) {
    ExtractionOptions options = method;
    options.order = methods.front().order;
    return method.method == engine::Method::fixed &&
           options == static_cast<const ExtractionOptions&>(methods.front());
  });
}

/// "0.1 to 0.894"
std::string orders_words(std::span<const StudyMethod> methods) {
  const auto [low, high] = std::ranges::minmax(methods, {}, &StudyMethod::order);
  return fmt::format("{:.3g} to {:.3g}", low.order, high.order);
}

/// Describes a method without its control.
std::string texture_words(const ExtractionOptions& method) {
  using enum engine::Method;
  switch (method.method) {
    case adaptive:
      return fmt::format(
          "adaptive fractional differential (K = {}, {}; orders from {} gradients of the sub-bands "
          "of {}, {})",
          method.radius, mask_words(method), gradient_words(method.gradient),
          counted(method.levels, "level"), combination_words(method.combine));
    case fixed:
      return fmt::format("fractional differential of the fixed order {} (K = {}, {})",
                         number_text(method.order), method.radius, mask_words(method));
    case tv_gabor:
      return tv_gabor_words(method.tv_gabor);
    case gaussian:
      return fmt::format("image minus its Gaussian average (standard deviation {} pixels)",
                         number_text(method.sigma_px));
    case median:
      return fmt::format(
          "image minus its median in a window of {0} x {0} pixels, where they differ by more than "
          "{1} grey levels",
          2 * method.radius + 1, number_text(method.threshold_grey));
    case edge:
      return fmt::format("norm of the Sobel gradient divided by {}, at most 127 grey levels",
                         number_text(method.divisor));
    case luminance:
      return "luminance (grey level minus 128)";
  }
  return {};
}

constexpr const char* kScrambled = "phase-scrambled control (same spectrum, random phases) of ";

/// The presented method whose control this is; null if there is none.
const StudyMethod* original_of(const StudyMethod& control, std::span<const StudyMethod> methods) {
  if (control.control == engine::Control::none) return nullptr;
  ExtractionOptions original = control;
  original.control = engine::Control::none;
  const auto found = std::ranges::find_if(methods, [&original](const StudyMethod& method) {
    return static_cast<const ExtractionOptions&>(method) == original;
  });
  return found == methods.end() ? nullptr : &*found;
}

std::string gain_list(const engine::Gains& gains, engine::ModelKind model) {
  if (model == engine::ModelKind::surface) {
    return fmt::format("alpha = {} mm per grey level", number_text(gains.height_mm));
  }
  return fmt::format("k_t = {} N per grey level per pixel and c = {} N per grey level",
                     number_text(gains.tangential_n), number_text(gains.normal_n));
}

}  // namespace

std::string words_of(const ExtractionOptions& method) {
  const bool scrambled = method.control == engine::Control::phase_scrambled;
  return (scrambled ? std::string(kScrambled) + "the " : "") + texture_words(method);
}

SettingFields fields_of_methods(const Study& study) {
  const auto presented =
      std::span(study.methods).first(static_cast<std::size_t>(study.presented_methods()));
  if (presented.size() > kMaxListedMethods && differ_only_in_order(presented)) {
    return {{fmt::format("{} orders", presented.size()),
             fmt::format("fractional differential of fixed orders from {} (K = {}, {})",
                         orders_words(presented), presented.front().radius,
                         mask_words(presented.front()))}};
  }
  SettingFields fields;
  for (const StudyMethod& method : presented) {
    const StudyMethod* const original = original_of(method, presented);
    fields.emplace_back(method.label, original == nullptr
                                          ? words_of(method)
                                          : kScrambled + in_quotes(original->label));
  }
  return fields;
}

std::string wall_words(const RenderingOptions& rendering) {
  const std::string stiffness = number_text(rendering.stiffness_n_per_mm) + " N/mm, ";
  if (rendering.damping_n_s_per_mm == 0.0) return stiffness + "without damping";
  return stiffness + "with a damping of " + number_text(rendering.damping_n_s_per_mm) + " N s/mm";
}

std::string force_words(const RenderingOptions& rendering) {
  const std::string limit = ", limited to " + number_text(rendering.max_force_n) + " N in all";
  if (rendering.model == engine::ModelKind::surface) {
    return "gradient of one potential (model \"surface\"): k e along the normal and −k e α ∇h "
           "along the plane, with k the wall's stiffness, e the depth plus the height α h and h "
           "the cubic spline through the texture" +
           (rendering.friction > 0.0
                ? ", with bristle friction of coefficient " + number_text(rendering.friction)
                : std::string(", without friction")) +
           limit;
  }
  return fmt::format(
      "wall with force planes (model \"paper\"): c (G − {}) is added to the wall's force; the "
      "force "
      "along the plane is k_t times the sum of (G_i − G_j) (p_j − p_i) / d² over the {} x {} "
      "pixels "
      "around the stylus, from bright to dark{}{}",
      number_text(rendering.reference_grey), rendering.neighbourhood, rendering.neighbourhood,
      rendering.touchdown_ramp_n > 0.0
          ? ", in proportion to the load up to " + number_text(rendering.touchdown_ramp_n) + " N"
          : std::string(),
      limit);
}

std::string filter_words(const RenderingOptions& rendering) {
  if (rendering.filter_mm == 0.0) return "none";
  return "Gaussian with a standard deviation of " + number_text(rendering.filter_mm) + " mm";
}

std::string gain_words(const Study& study) {
  const RenderingOptions& rendering = study.rendering;
  std::string words;
  if (study.level) {
    words = fmt::format(
        "those that set the weakest stimulus {} dB above the detection threshold{} (curve "
        "\"{}\")",
        number_text(study.level->db), study.device.empty() ? "" : " on \"" + study.device + "\"",
        study.level->curve);
  } else if (rendering.gains) {
    words = "stated: " + gain_list(*rendering.gains, rendering.model);
  } else {
    words = fmt::format(
        "the largest that keep the 99th percentile of the stiffness of all stimuli's texture "
        "forces within {} N/mm",
        number_text(rendering.texture_stiffness_n_per_mm));
  }
  static constexpr auto kEqualised = std::to_array<Named<engine::Equalise>>(
      {{", equal for all stimuli", engine::Equalise::none},
       {", scaled for equal rms forces of all stimuli", engine::Equalise::rms},
       {", scaled for an equal level of all stimuli", engine::Equalise::level}});
  return words + std::string(name_in(kEqualised, rendering.equalise));
}

SettingFields fields_of_rendering(const Study& study) {
  const RenderingOptions& rendering = study.rendering;
  SettingFields fields = {{"wall", wall_words(rendering)},
                          {"forces of textures", force_words(rendering)},
                          {"pitch", number_text(rendering.pitch_mm) + " mm per pixel"},
                          {"reconstruction filter", filter_words(rendering)},
                          {"gains", gain_words(study)}};
  if (!study.device.empty()) fields.emplace_back("device", study.device);
  return fields;
}

SettingFields fields_of(const ValidityRule& rule) {
  return {{"exploration from landing", "at least " + number_text(rule.min_exploring_s) + " s"},
          {"contact", "at least " + number_text(rule.min_contact_s) + " s"},
          {"path in contact", "at least " + number_text(rule.min_path_mm) + " mm"},
          {"median force in contact", "from " + number_text(rule.min_median_n) + " to " +
                                          number_text(rule.max_median_n) + " N"},
          {"samples at the force limit",
           "less than " + number_text(100 * rule.saturated_share) + " % of those in contact"},
          {"servo", "no missed tick in contact"}};
}

std::string touch_words(const MinTouch& touch) {
  if (touch == MinTouch{0.0, 0.0}) return "no touch needed";
  return "at least " + number_text(touch.contact_s) + " s at the plane and " +
         number_text(touch.path_mm) + " mm along it, unless time is up";
}

std::string range_words(const HandRange& range) {
  return number_text(range.slowest_mm_s) + " to " + number_text(range.fastest_mm_s) + " mm/s and " +
         number_text(range.lightest_n) + " to " + number_text(range.strongest_n) + " N";
}

std::string practice_words(const Study& study) {
  const Practice practice = practice_of(study);
  const auto trials = static_cast<int>(practice.trials.size());
  if (trials == 0) return "none";
  const auto textures = static_cast<int>(study.practice.classes.size());
  const std::string what =
      textures == 0 ? std::string(" a round at the highest level")
                    : " a round of " + counted(textures, "texture") + " that are not in the study";
  return counted(trials, textures == 0 ? "trial" : "presentation") + what +
         (practice.criterion > 0 ? "; criterion " + std::to_string(practice.criterion) + " correct"
                                 : std::string()) +
         ", " + counted(practice.rounds, "round") + " at most";
}

std::string visits_words(const VisitPlan& visits) {
  if (visits.count == 1) return "";
  std::string days = "at least " + number_text(visits.min_days);
  if (visits.max_days) days += " and at most " + number_text(*visits.max_days);
  const bool divided = visits.methods == VisitMethods::divided;
  return std::to_string(visits.count) + ", " + days + " days between them, " +
         (divided ? "the methods divided between them" : "all methods at each");
}

std::string language_words(const SessionPlan& session) {
  const std::string draft = draft_notice(session.language);
  return language_of(session.language).name + (draft.empty() ? "" : ": " + draft);
}

std::string sight_words(const Study& study) {
  if (study.session.sight == Sight::blindfold) {
    return "nothing (blindfold; names of the textures were learnt by heart)";
  }
  const TrialQuestion question = trial_question_of(study);
  const std::string curtain = "a curtain before hand and device";
  if (question.has_pictures()) return curtain + ", and pictures of the textures on a screen";
  return question.scales().empty() ? curtain : curtain + ", and one picture with each question";
}

std::string masking_words(const MaskingPlan& masking) {
  if (!masking.wanted) return "none";
  return "pink noise at " + number_text(masking.level_dbfs) + " dB re full scale (rms)";
}

}  // namespace touchtrial::study
