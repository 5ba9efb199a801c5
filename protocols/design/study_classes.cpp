/// The study file's "classes".
#include "protocols/design/study_sections.hpp"
#include "protocols/design/study_texts.hpp"

#include <algorithm>
#include <set>

namespace touchtrial::design {
namespace {

constexpr std::size_t kLongestLabel = 64;   // bytes
constexpr std::size_t kLongestPath = 1024;  // bytes

std::string read_label(const JsonValue& place) {
  const std::string& label = place.text();
  if (label.empty()) place.refuse("is empty; give the class a label");
  if (label.size() > kLongestLabel) {
    place.refuse("has " + std::to_string(label.size()) + " bytes, must have at most " +
                 std::to_string(kLongestLabel) + "; shorten it");
  }
  if (has_control_character(label)) place.refuse("has a control character; remove it");
  if (label.front() == ' ' || label.back() == ' ') {
    place.refuse("begins or ends with a blank; remove it");
  }
  return label;
}

std::string read_image(const JsonValue& place) {
  const std::string& path = place.text();
  if (path.empty()) place.refuse("is empty; give the path of an image");
  if (path.size() > kLongestPath) {
    place.refuse("is longer than " + std::to_string(kLongestPath) + " bytes; shorten the path");
  }
  if (has_control_character(path)) place.refuse("has a control character; rename the image");
  return path;
}

std::vector<std::filesystem::path> read_images(const JsonValue& place, std::size_t most) {
  std::vector<std::filesystem::path> images;
  std::set<std::string> seen;
  for (const JsonValue& item : place.items(1, most)) {
    const std::string path = read_image(item);
    if (!seen.insert(path).second) {
      item.refuse(in_quotes(path) + " is there twice; list each image of a class once");
    }
    images.emplace_back(path);
  }
  return images;
}

}  // namespace

std::vector<StudyClass> read_classes(const JsonValue& place, std::size_t most_images) {
  std::vector<StudyClass> classes;
  for (const JsonValue& item : place.items(2, kMaxClasses)) {
    const JsonObject object = item.object({"label", "images"});
    StudyClass study_class{read_label(object.at("label")),
                           read_images(object.at("images"), most_images)};
    const bool taken = std::any_of(classes.begin(), classes.end(), [&](const StudyClass& other) {
      return other.label == study_class.label;
    });
    if (taken) {
      object.at("label").refuse(in_quotes(study_class.label) +
                                " is the label of another class; labels must be unique");
    }
    classes.push_back(std::move(study_class));
  }
  return classes;
}

}  // namespace touchtrial::design
