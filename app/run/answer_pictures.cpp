#include "app/run/answer_pictures.hpp"

#include "engine/image_file.hpp"

namespace touchtrial::app {

std::map<std::string, GreyImage> answer_pictures(const design::Study& study) {
  std::map<std::string, GreyImage> pictures;
  const auto add = [&](const std::vector<design::StudyClass>& classes) {
    for (const design::StudyClass& shown : classes) {
      pictures.emplace(shown.label, engine::read_grey_image(study.folder / shown.images.front()));
    }
  };
  add(study.classes);
  add(study.practice.classes);
  return pictures;
}

}  // namespace touchtrial::app
