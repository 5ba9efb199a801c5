/// \file Describes the study file's "methods".
#include "core/text.hpp"
#include "study/study_options.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <span>

namespace touchtrial::study {
namespace {

/// A key besides "name", and the methods that use it.
struct MethodKey {
  std::string_view key;
  std::vector<engine::Method> methods;
};

const std::vector<MethodKey>& method_keys() {
  using enum engine::Parameter;
  static const std::vector<MethodKey> keys = {
      {"radius", methods_with(radius)},
      {"order", methods_with(order)},
      {"norm", methods_with(norm)},
      {"gradient", methods_with(gradient)},
      {"combine", methods_with(combine)},
      {"levels", methods_with(levels)},
      {"sigma_px", methods_with(sigma)},
      {"threshold", methods_with(threshold)},
      {"divisor", methods_with(divisor)},
      {"lambda", methods_with(lambda)},
      {"components", methods_with(components)},
      {"gap", methods_with(gap)},
      {"max_steps", methods_with(max_steps)},
  };
  return keys;
}

std::vector<std::string_view> names_of(const std::vector<engine::Method>& methods) {
  std::vector<std::string_view> names;
  for (const engine::Method method : methods) names.push_back(name_of(method));
  return names;
}

/// Describes the method's name, and the keys that only some methods have.
void describe_name(ObjectIo& io, engine::Method& method) {
  const std::vector<std::string> names = engine::method_names();
  const std::vector<std::string_view> views(names.begin(), names.end());
  auto index = static_cast<std::size_t>(std::ranges::find(views, name_of(method)) - views.begin());
  io.member("name", {.meaning = "the extraction method", .required = true}, true,
            [&](ValueIo& value) { value.choice(index, views); });
  method = engine::method_from_name(names.at(index)).value();
  for (const MethodKey& entry : method_keys()) {
    const std::vector<std::string_view> owners = names_of(entry.methods);
    io.only_for("name", owners, std::span(&entry.key, 1),
                (owners.size() == 1 ? "belongs to the method " : "belongs to the methods ") +
                    listed(owners, " and ") + ", not to " + std::string(name_of(method)) +
                    "; remove it");
  }
}

void describe_component(ObjectIo& io, engine::GaborComponent& component) {
  io.number("frequency", component.frequency_cycles_per_px,
            {.low = 0.0, .high = 0.5, .open_low = true},
            {.meaning = "frequency of the wave", .required = true, .unit = "cycles per pixel"});
  io.number(
      "direction", component.direction_deg, {.low = -360.0, .high = 360.0},
      {.meaning = "direction of the wave, from the x axis", .required = true, .unit = "degrees"});
}

/// Describes components: a list, or the word "auto".
void describe_components(ValueIo& io, engine::TvGaborOptions& options) {
  constexpr auto kWords = std::to_array<Named<bool>>({{"auto", true}});
  const ValueIo::Form forms[] = {{[](const JsonValue& place) { return place.is_text(); },
                                  [&](ValueIo& value) {
                                    options.automatic = true;
                                    value.choice(options.automatic, kWords);
                                  }},
                                 {{}, [&](ValueIo& value) {
                                    options.automatic = false;
                                    value.list(
                                        options.components, {.min = 1, .max = 64},
                                        [](ValueIo& item, engine::GaborComponent& component) {
                                          item.part(component, describe_component);
                                        });
                                  }}};
  io.one_of(options.automatic ? 0 : 1, forms);
}

/// Composes the description of a key, with the methods that use it.
class KeyDescriptions {
 public:
  /// \param key  one of method_keys()
  KeyInfo describe(std::string_view key, std::string_view meaning, std::string_view unit = {}) {
    const auto entry = std::ranges::find(method_keys(), key, &MethodKey::key);
    text_ = std::string(meaning) + " (" + listed(names_of(entry->methods)) + ")";
    const bool is_used = std::ranges::count(entry->methods, method_) > 0;
    return {.meaning = text_, .written = is_used, .unit = unit};
  }
  explicit KeyDescriptions(engine::Method method) : method_(method) {}

 private:
  engine::Method method_;
  std::string text_;
};

void describe_tv_gabor(ObjectIo& io, engine::TvGaborOptions& options, KeyDescriptions& keys) {
  using Options = engine::TvGaborOptions;
  io.number("lambda", options.lambda, {.low = Options::kMinLambda, .high = Options::kMaxLambda},
            keys.describe("lambda", "weight of the texture norm"));
  KeyInfo components = keys.describe(
      "components",
      "the oscillations that count as texture; `auto` selects the strongest ones of each image");
  components.range = "1 to 64 entries, or `auto`";
  components.default_text = "four at 0.25, 0, 45, 90, 135 degrees";
  io.member("components", components, true,
            [&options](ValueIo& value) { describe_components(value, options); });
  io.number("gap", options.gap, {.low = 0.0, .high = 1.0, .open_low = true},
            keys.describe("gap", "relative primal-dual gap at which the solver stops"));
  io.integer("max_steps", options.max_steps, 1, 1'000'000,
             keys.describe("max_steps",
                           "maximum number of solver steps; `prepare` warns if it is reached"));
}

void describe_parameters(ObjectIo& io, engine::ExtractionOptions& options) {
  using Options = engine::ExtractionOptions;
  KeyDescriptions keys(options.method);
  io.integer("radius", options.radius, 1, Options::kMaxRadius,
             keys.describe("radius",
                           "radius K of the mask, or of the median's window, which is 2 K + 1 wide",
                           "pixels"));
  io.number("order", options.order, {.low = 0.0, .high = 1.0, .open_high = true},
            keys.describe("order", "fractional order v; 0 gives no texture"));
  io.choice("norm", options.norm, engine::kNormNames,
            keys.describe("norm", "normalisation of the mask; `sum` is strong where v is near 1"));
  io.choice("gradient", options.gradient, engine::kGradientNames,
            keys.describe("gradient", "operator that measures the slope of the sub-bands"));
  io.choice("combine", options.combine, engine::kCombineNames,
            keys.describe("combine", "how the slopes of all sub-bands are combined"));
  io.integer("levels", options.levels, 1, Options::kMaxLevels,
             keys.describe("levels", "levels of sub-bands"));
  io.number(
      "sigma_px", options.sigma_px, {.low = 0.0, .high = Options::kMaxSigma_px, .open_low = true},
      keys.describe("sigma_px", "standard deviation of the Gaussian blur that is subtracted"));
  io.number(
      "threshold", options.threshold_grey, {.low = 0.0, .high = 255.0},
      keys.describe("threshold", "differences from the median up to this value are not texture",
                    "grey levels"));
  io.number("divisor", options.divisor, {.low = Options::kMinDivisor, .high = Options::kMaxDivisor},
            keys.describe("divisor", "divisor of the norm of the gradient"));
  describe_tv_gabor(io, options.tv_gabor, keys);
}

void describe(ObjectIo& io, StudyMethod& method) {
  describe_name(io, method.method);
  describe_parameters(io, method);
  io.choice("control", method.control, engine::kControlNames,
            {.meaning = "`phase-scrambled`: a texture with the same spectrum as the method's "
                        "texture but without its structure",
             .written = method.control != engine::Control::none});
  io.rule([&method](const JsonValue& /*place*/, const JsonObject& /*object*/) {
    method.label = default_label(method);
  });
  io.text("label", method.label, kPlainName,
          {.meaning = "name in tables and files, unique like labels of classes; required if two "
                      "entries have the same method",
           .written = method.label != default_label(method),
           .default_text = "the name and the control"});
}

}  // namespace

std::string default_label(const engine::ExtractionOptions& method) {
  std::string label(name_of(method.method));
  if (method.control != engine::Control::none)
    label += "-" + std::string(name_in(engine::kControlNames, method.control));
  return label;
}

void describe_methods(ObjectIo& io, std::vector<StudyMethod>& methods, const KeyInfo& info) {
  io.list("methods", methods, {.min = 1, .max = kMaxMethods}, info,
          [](ValueIo& value, StudyMethod& method) {
            value.object([&method](ObjectIo& keys) { describe(keys, method); });
          });
  io.rule([&methods](const JsonValue& place, const JsonObject& /*object*/) {
    for (std::size_t i = 1; i < methods.size(); ++i) {
      const std::string pointer = "/methods/" + std::to_string(i);
      const std::string& label = methods[i].label;
      const std::span earlier_methods = std::span(methods).first(i);
      if (std::ranges::count(earlier_methods, label, &StudyMethod::label) > 0) {
        place.refuse_below(pointer, in_quotes(label) +
                                        " occurs twice; list it once, or give one of them another "
                                        "label");
      }
      for (const StudyMethod& other : earlier_methods) {
        refuse_same_label(place, pointer, label, other.label, "method");
      }
    }
  });
}

engine::ExtractionOptions parse_method(std::string_view text, const std::string& source) {
  StudyMethod method;
  read_settings(parse_strict_json(text, source), [&](ObjectIo& io) { describe(io, method); });
  return method;
}

nlohmann::json to_json(const StudyMethod& method) {
  StudyMethod copy = method;
  const Description description = [&copy](ObjectIo& io) { describe(io, copy); };
  return written_section(description, [](ObjectIo& /*io*/) {});
}

nlohmann::json to_json(const engine::ExtractionOptions& method) {
  StudyMethod labelled{method, default_label(method)};
  return to_json(labelled);
}

}  // namespace touchtrial::study
