#include "dynamics/urdf/urdf_tree.hpp"

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "errors.hpp"

namespace codesign::dynamics {
namespace {

// urdfdom must not see a loop: it would never free its links.
class Tree {
 public:
  explicit Tree(const UrdfText& text) : text_(text) {
    for (const std::string& link : text.links) {
      if (!parents_.emplace(link, nullptr).second) fail("link", link, "is defined twice");
    }
    std::set<std::string> names;
    for (const UrdfText::Joint& joint : text.joints) {
      if (!names.insert(joint.name).second) fail("joint", joint.name, "is defined twice");
      add(joint);
    }
  }

  // Name of the root.
  std::string root() const {
    if (text_.links.empty()) throw UrdfError("the robot has no links");
    std::string root;
    for (const std::string& link : text_.links) {
      if (parents_.at(link) != nullptr) continue;
      if (!root.empty()) {
        fail("link", link, "is a second root: no joint leads to it, nor to \"" + root + "\"");
      }
      root = link;
    }
    std::set<std::string> reached = {root};
    for (const std::string& start : text_.links) {
      // Up to what is known to be connected to the root; a walk longer than the robot is a loop.
      std::vector<std::string> walk;
      std::string link = start;
      while (!reached.contains(link)) {
        walk.push_back(link);
        const UrdfText::Joint* joint = parents_.at(link);
        if (joint == nullptr || walk.size() > text_.links.size()) {
          fail("link", start, "is not connected to a root link: the joints form a loop");
        }
        link = joint->parent;
      }
      reached.insert(walk.begin(), walk.end());
    }
    return root;
  }

 private:
  void add(const UrdfText::Joint& joint) {
    for (const auto& [role, link] :
         {std::pair("parent", &joint.parent), std::pair("child", &joint.child)}) {
      if (link->empty()) fail("joint", joint.name, std::string("has no ") + role + " link");
      if (!parents_.contains(*link)) {
        fail("joint", joint.name,
             std::string("has the ") + role + " link \"" + *link + "\", which does not exist");
      }
    }
    const UrdfText::Joint*& above = parents_.at(joint.child);
    if (above != nullptr) {
      fail("link", joint.child,
           "is the child of two joints, \"" + above->name + "\" and \"" + joint.name + "\"");
    }
    above = &joint;
  }

  [[noreturn]] static void fail(const std::string& kind, const std::string& name,
                                const std::string& reason) {
    throw UrdfError(kind + " \"" + name + "\" " + reason);
  }

  const UrdfText& text_;
  std::map<std::string, const UrdfText::Joint*> parents_;  // link → joint above it
};

}  // namespace

std::string root_of_tree(const UrdfText& text) { return Tree(text).root(); }

}  // namespace codesign::dynamics
