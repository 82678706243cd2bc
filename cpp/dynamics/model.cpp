#include "dynamics/model.hpp"

#include "errors.hpp"

namespace codesign::dynamics {
namespace {

template <typename Named>
int index_of(const Model& model, const std::vector<Named>& items, std::string_view name,
             const char* kind) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == name) return static_cast<int>(i);
  }
  std::string message =
      "robot \"" + model.name + "\" has no " + kind + " \"" + std::string(name) + "\"; it has: ";
  constexpr std::size_t kListed = 40;
  for (std::size_t i = 0; i < items.size() && i < kListed; ++i) {
    message += (i ? ", " : "") + items[i].name;
  }
  if (items.size() > kListed) message += ", ...";
  throw UnknownNameError(message);
}

}  // namespace

int frame_index(const Model& model, std::string_view name) {
  return index_of(model, model.frames, name, "frame");
}

int joint_index(const Model& model, std::string_view name) {
  return index_of(model, model.joints, name, "joint");
}

}  // namespace codesign::dynamics
