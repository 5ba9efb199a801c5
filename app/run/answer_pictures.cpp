#include "app/run/answer_pictures.hpp"

#include "engine/image_file.hpp"

namespace touchtrial {

std::map<std::string, GreyImage> answer_pictures(const Study& study) {
  std::map<std::string, GreyImage> pictures;
  const auto add = [&](const std::vector<StudyClass>& classes) {
    for (const StudyClass& shown : classes) {
      pictures.emplace(shown.label, read_grey_image(study.folder / shown.images.front()));
    }
  };
  add(study.classes);
  add(study.practice.classes);
  return pictures;
}

}  // namespace touchtrial
