#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/identification/study/identification.hpp"
#include "study/study.hpp"
#include "study/study_examples.hpp"
#include "study/study_options.hpp"
#include "study/study_sections.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using nlohmann::json;

/// The error that a text is refused with; empty if it is accepted.
std::string refusal_of_text(const std::string& text) {
  return message_of<StudyError>([&] { return study::parse_study(text, "", "study.json"); });
}

void check_names(const std::string& message, const std::string& places) {
  CHECK_THAT(message, names(places));
}

}  // namespace

TEST_CASE("a study with the required keys alone has the documented defaults") {
  const study::Study study = parsed(minimal_study());
  CHECK(study.name == "small");
  CHECK(study.protocol == &study::identification::classification());
  REQUIRE(study.classes.size() == 2);
  CHECK(study.classes[1].label == "smooth");
  CHECK(study.classes[1].images == std::vector<std::filesystem::path>{"smooth.png"});
  REQUIRE(study.methods.size() == 1);
  CHECK(study.methods[0] == engine::ExtractionOptions{});
  CHECK(study.rendering == engine::RenderingOptions{});
  CHECK(study.trials == study::TrialOptions{});
  CHECK(study.seed == 0);
  CHECK(study.folder == "somewhere");
  CHECK(json::parse(study.text) == minimal_study());
}

TEST_CASE("every key of a full study is read") {
  json document = comparison_of(3, 2);
  document.update(json::parse(R"({
    "methods": [{"name": "fixed", "radius": 4, "order": 0.25},
                {"name": "tv-gabor", "lambda": 0.02, "gap": 1e-4, "max_steps": 77,
                 "components": [{"frequency": 0.1, "direction": 30}]}],
    "rendering": {"model": "paper", "pitch_mm": 0.1, "stiffness_n_per_mm": 0.5,
      "damping_n_s_per_mm": 0.001, "filter_mm": 0.3, "texture_stiffness_n_per_mm": 0.2,
      "gains": {"tangential_n": 0.01, "normal_n": 0.02}, "equalise": "rms",
      "reference_grey": 100.5, "friction": 0.0, "neighbourhood": 5, "touchdown_ramp_n": 0.2,
      "max_force_n": 2},
    "trials": {"repeats": 7, "order": "uniform", "explore_limit_s": 30,
      "on_timeout": "no-response", "practice": 0, "break_every": 10, "catch": 3, "lead_in": 2,
      "blocks": "mixed", "max_run": 4, "rove_db": 2.5, "on_interruption": "leave-out",
      "resume_within_h": 2.5},
    "seed": 9007199254740992})"));
  const study::Study study = parsed(document);
  CHECK(study.protocol == &study::identification::comparison());
  CHECK(study.classes[2].images.size() == 2);
  CHECK(study.methods[0].method == engine::Method::fixed);
  CHECK(study.methods[0].radius == 4);
  CHECK(study.methods[0].order == 0.25);
  CHECK(study.methods[1].tv_gabor == engine::TvGaborOptions{0.02, {{0.1, 30.0}}, 1e-4, 77});
  const engine::RenderingOptions rendering{.pitch_mm = 0.1,
                                           .stiffness_n_per_mm = 0.5,
                                           .damping_n_s_per_mm = 0.001,
                                           .filter_mm = 0.3,
                                           .texture_stiffness_n_per_mm = 0.2,
                                           .gains = engine::Gains{0.01, 0.02},
                                           .equalise = engine::Equalise::rms,
                                           .reference_grey = 100.5,
                                           .neighbourhood = 5,
                                           .touchdown_ramp_n = 0.2,
                                           .max_force_n = 2.0};
  CHECK(study.rendering == rendering);
  const study::TrialOptions trials{.repeats = 7,
                                   .order = study::TrialOrder::uniform,
                                   .explore_limit_s = 30.0,
                                   .on_timeout = study::OnTimeout::no_response,
                                   .break_every = 10,
                                   .catch_trials = 3,
                                   .lead_in = 2,
                                   .blocks = study::Blocks::mixed,
                                   .max_run = 4,
                                   .rove_db = 2.5,
                                   .on_interruption = study::OnInterruption::leave_out,
                                   .resume_within_h = 2.5};
  CHECK(study.trials == trials);
  CHECK(study.seed == 9007199254740992U);
}

TEST_CASE("a classification presents its first method alone, a comparison all") {
  json document = comparison_of(4);
  CHECK(parsed(document).presented_methods() == 2);
  CHECK(parsed(document).scored_trials() == 4 * 2 * 5);
  document["protocol"] = "classification";
  CHECK(parsed(document).presented_methods() == 1);
  CHECK(parsed(document).scored_trials() == 4 * 5);
}

TEST_CASE("what a study cannot be is refused at its place, with what helps") {
  const json pair = comparison_of(2);
  struct Refused {
    json study;
    const char* place;
    json value;  ///< null: the place is erased
    const char* places;
  };
  const std::vector<Refused> all = {
      {minimal_study(), "/rendering/pich_mm", 0.2, "/rendering/pich_mm pitch_mm"},
      {minimal_study(), "/methods/0/Radius", 2, "/methods/0/Radius radius"},
      {minimal_study(), "/classes/1/colour~1depth~0", 1, "/classes/1/colour~1depth~0"},
      {minimal_study(), "/trials/order", "shufled", "/trials/order shufled shuffled "},
      {minimal_study(), "/protocol", {}, "/protocol"},
      {minimal_study(), "/classes/0/images", {}, "/classes/0/images"},
      {minimal_study(), "/methods/0/lambda", 0.01, "/methods/0/lambda"},
      {minimal_study(), "/methods/0", R"({"name": "tv-gabor", "radius": 2})"_json,
       "/methods/0/radius"},
      {minimal_study(), "/rendering", R"({"model": "surface", "gains": {"normal_n": 0.01}})"_json,
       "/rendering/gains/normal_n"},
      {minimal_study(), "/rendering", R"({"model": "paper", "gains": {"height_mm": 0.01}})"_json,
       "/rendering/gains/height_mm"},
      {minimal_study(), "/rendering", R"({"model": "surface", "gains": {}})"_json,
       "/rendering/gains/height_mm: "},
      {minimal_study(), "/rendering/friction", 0.3, "/rendering/friction 0"},
      {minimal_study(), "/blinding", "single", "/blinding single"},
      {minimal_study(), "/protocol", "comparison", "/methods 1 2"},
      {pair, "/methods/1", R"({"name": "adaptive", "radius": 3})"_json, "/methods/1 adaptive "},
      {pair, "/methods/1", R"({"name": "adaptive", "label": "Adaptive"})"_json,
       "/methods/1 Adaptive adaptive"},
      {minimal_study(), "/classes/0/images", R"(["a.png", "b.png", "a.png"])"_json,
       "/classes/0/images/2 a.png"},
      {minimal_study(), "/classes/0/images", {""}, "/classes/0/images/0"},
      {study_of(64), "/trials/repeats", 1000, "/trials/repeats 64000"},
      {comparison_of(6, 1000), "/seed", 1, "/classes 6000 2"}};
  for (auto [study, place, value, places] : all) {
    const json::json_pointer at(place);
    if (value.is_null()) {
      study[at.parent_pointer()].erase(at.back());
    } else {
      study[at] = value;
    }
    INFO(place << " = " << value.dump());
    CHECK_THAT(refusal_of(study), names("study.json") && names(places));
  }
}

TEST_CASE("malformed or absurdly nested JSON is refused with line and column, unharmed") {
  const std::vector<std::pair<std::string, const char*>> texts = {
      {"{\n  \"study\": tru\n}", "study.json 2 15"},
      {"", "study.json 1"},
      {"{\"a\": 1,}", "study.json 1 9"},
      {"{} no", "1 5"},
      {"{\"a\": \"\xff\"}", "study.json UTF-8"},
      {"[]", "study.json /"},
      {std::string(1'000'000, '['), "study.json"}};
  for (const auto& [text, places] : texts) {
    INFO(text.substr(0, 40));
    CHECK_THAT(refusal_of_text(text), names(places));
  }
}

TEST_CASE("every method is read with its options, and written again as it was read") {
  json document = comparison_of(2);
  document["methods"] = {{{"name", "adaptive"},
                          {"norm", "sum"},
                          {"gradient", "prewitt"},
                          {"combine", "max"},
                          {"levels", 3}},
                         {{"name", "tv-gabor"}, {"components", "auto"}},
                         {{"name", "gaussian"}, {"sigma_px", 1.5}},
                         {{"name", "median"}, {"radius", 3}, {"threshold", 0}},
                         {{"name", "edge"}, {"divisor", 2}},
                         {{"name", "luminance"}}};
  const study::Study study = parsed(document);
  REQUIRE(study.methods.size() == 6);
  CHECK(study.methods[0].norm == engine::Norm::sum);
  CHECK(study.methods[0].gradient == engine::Gradient::prewitt);
  CHECK(study.methods[0].combine == engine::Combine::max);
  CHECK(study.methods[0].levels == 3);
  CHECK(study.methods[1].tv_gabor.automatic);
  CHECK(study.methods[2].sigma_px == 1.5);
  CHECK(study.methods[3].radius == 3);
  CHECK(study.methods[3].threshold_grey == 0.0);
  CHECK(study.methods[4].divisor == 2.0);
  CHECK(study.methods[5].method == engine::Method::luminance);
  json again = document;
  again["methods"] = json::array();
  for (const study::StudyMethod& method : study.methods)
    again["methods"].push_back(study::to_json(method));
  CHECK(again["methods"][1]["components"] == "auto");
  CHECK(again["methods"][5] == json{{"name", "luminance"}});
  CHECK(parsed(again).methods == study.methods);
}

TEST_CASE("a method and its control, or two settings of one method, are told apart by labels") {
  json document = comparison_of(2);
  document["methods"] = {{{"name", "adaptive"}},
                         {{"name", "adaptive"}, {"control", "phase-scrambled"}},
                         {{"name", "adaptive"}, {"radius", 7}, {"label", "wide"}}};
  const study::Study study = parsed(document);
  CHECK(study.methods[0].label == "adaptive");
  CHECK(study.methods[1].label == "adaptive-phase-scrambled");
  CHECK(study.methods[1].control == engine::Control::phase_scrambled);
  CHECK(study.methods[2].label == "wide");
  json again = document;
  again["methods"] = json::array();
  for (const study::StudyMethod& method : study.methods)
    again["methods"].push_back(study::to_json(method));
  CHECK_FALSE(again["methods"][0].contains("label"));
  CHECK_FALSE(again["methods"][0].contains("control"));
  CHECK(parsed(again).methods == study.methods);
  document["methods"][2]["label"] = "adaptive";
  check_names(refusal_of(document), "/methods/2 adaptive");
  document["methods"][2]["label"] = "a b";
  check_names(refusal_of(document), "/methods/2/label 1 64");
}

TEST_CASE("a study with the surface model has its own gains and friction") {
  json document = minimal_study();
  document["rendering"] = {
      {"model", "surface"}, {"gains", {{"height_mm", 0.004}}}, {"friction", 0.25}};
  const engine::RenderingOptions expected{.model = engine::ModelKind::surface,
                                          .gains = engine::Gains{.height_mm = 0.004},
                                          .friction = 0.25};
  CHECK(parsed(document).rendering == expected);
  document["rendering"]["gains"] = "budget";
  CHECK_FALSE(parsed(document).rendering.gains);
}

TEST_CASE("a touchdown ramp is read as it was written, and refused beside the surface model") {
  json document = minimal_study();
  document["rendering"] = {{"touchdown_ramp_n", 0.25}};
  const engine::RenderingOptions ramped = parsed(document).rendering;
  CHECK(ramped.touchdown_ramp_n == 0.25);
  CHECK(study::parse_rendering(study::written_rendering(ramped), "written") == ramped);
  const std::string plain = study::written_rendering(engine::RenderingOptions{});
  CHECK(json::parse(plain).at("touchdown_ramp_n") == 0.0);
  document["rendering"] = {{"model", "surface"}, {"touchdown_ramp_n", 0.25}};
  check_names(refusal_of(document), "/rendering/touchdown_ramp_n 0");
}

TEST_CASE("a study sets its validity rule and the touch before an answer") {
  json document = minimal_study();
  document["trials"]["validity"] = {{"exploring_s", 2}, {"path_mm", 100}};
  document["trials"]["answer_after"] = {{"contact_s", 0}, {"path_mm", 0}};
  const study::TrialOptions trials = parsed(document).trials;
  CHECK(trials.validity.min_exploring_s == 2.0);
  CHECK(trials.validity.min_contact_s == 5.0);
  CHECK(trials.validity.min_path_mm == 100.0);
  CHECK(trials.answer_after == study::MinTouch{0.0, 0.0});
  document["trials"] = study::to_json(trials);
  CHECK(parsed(document).trials == trials);
}

TEST_CASE("labels that tables could not tell apart or print are refused") {
  json document = minimal_study();
  const auto with_label = [&](const std::string& label) {
    document["classes"][1]["label"] = label;
    return refusal_of(document);
  };
  check_names(with_label("rough"), "/classes/1/label rough");
  check_names(with_label("Rough"), "/classes/1/label Rough rough");
  check_names(with_label(""), "/classes/1/label");
}

TEST_CASE("a name that would not do as a file name is refused") {
  json document = minimal_study();
  for (const char* name : {"", "a b", "../x", "a/b", "\xc3\xa9"}) {
    document["study"] = name;
    check_names(refusal_of(document), "/study 1 64 0-9 _");
  }
  document["study"] = std::string(65, 'a');
  check_names(refusal_of(document), "/study");
}

TEST_CASE("the order de-bruijn needs as many repeats as classes, no lead-in and blocks by method") {
  json document = comparison_of(4);
  document["trials"] = {{"order", "de-bruijn"}, {"repeats", 5}};
  check_names(refusal_of(document), "/trials/repeats 5 4");
  document["trials"]["repeats"] = 4;
  CHECK(refusal_of(document).empty());
  document["trials"]["lead_in"] = 1;
  check_names(refusal_of(document), "/trials/lead_in 0");
  document["trials"]["lead_in"] = 0;
  document["trials"]["blocks"] = "mixed";
  check_names(refusal_of(document), "/trials/blocks by-method");
}

TEST_CASE("whole numbers may be written with a decimal point, others may not be rounded") {
  json document = minimal_study();
  document["trials"]["repeats"] = 5.0;
  CHECK(parsed(document).trials.repeats == 5);
  document["trials"]["repeats"] = 5.5;
  check_names(refusal_of(document), "/trials/repeats");
}

TEST_CASE("numbers that no whole number type or double holds are refused") {
  const auto with_seed = [](const std::string& seed) {
    std::string text = minimal_study().dump();
    text.pop_back();
    return refusal_of_text(text + ",\"seed\":" + seed + "}");
  };
  CHECK(with_seed("9007199254740992").empty());
  for (const char* seed : {"9007199254740993", "18446744073709551615", "18446744073709551616", "-1",
                           "-9223372036854775809", "1e300"}) {
    check_names(with_seed(seed), "study.json /seed ");
  }
  check_names(with_seed("1e999"), "study.json /seed");
  check_names(with_seed("NaN"), "study.json 1");
}

TEST_CASE("a key that occurs twice is refused wherever it is") {
  std::string text = minimal_study().dump();
  text.pop_back();
  check_names(refusal_of_text(text + ",\"study\":\"other\"}"), "study.json /study");
  check_names(refusal_of_text(R"({"classes":[{},{"label":"a","label":"b"}]})"),
              "study.json /classes/1/label");
}

TEST_CASE("hostile keys and values stay on one line of bounded length") {
  json document = minimal_study();
  document["a\nb" + std::string(10'000, 'x')] = 1;
  const std::string key_refused = refusal_of(document);
  CHECK(key_refused.find('\n') == std::string::npos);
  CHECK(key_refused.size() < 400);
  document = minimal_study();
  document["protocol"] = "a\nb" + std::string(10'000, 'x');
  const std::string value_refused = refusal_of(document);
  CHECK(value_refused.find('\n') == std::string::npos);
  CHECK(value_refused.size() < 400);
}

TEST_CASE("a study file is read from disk, with images relative to its folder") {
  const TempFolder folder;
  const auto path = folder.path() / "small.json";
  replace_file(path, minimal_study().dump(2));
  const study::Study study = study::load_study(path);
  CHECK(study.folder == folder.path());
  CHECK(study.text == minimal_study().dump(2));
}

TEST_CASE("a study file that is missing, a folder or far too large is refused as a study") {
  const TempFolder folder;
  CHECK_THROWS_AS(study::load_study(folder.path() / "none.json"), StudyError);
  CHECK_THROWS_AS(study::load_study(folder.path()), StudyError);
  replace_file(folder.path() / "large.json", std::string((16U << 20U) + 1, ' '));
  CHECK_THROWS_AS(study::load_study(folder.path() / "large.json"), StudyError);
}

}  // namespace touchtrial
