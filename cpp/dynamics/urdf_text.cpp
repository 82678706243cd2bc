#include "dynamics/urdf_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "dynamics/xml_reader.hpp"
#include "errors.hpp"

namespace codesign::dynamics {
namespace {

constexpr int kMaxElements = 5000;  // links and joints
constexpr std::size_t kMaxNameLength = 1000;
constexpr double kLargestNumber = 1e9;  // of a length, an angle, a mass, an inertia, in SI units
constexpr double kAnyNumber = std::numeric_limits<double>::max();

struct NumberRule {
  std::string_view element, attribute;
  int count;
  double largest;
};
constexpr std::array kNumbers = {NumberRule{"origin", "xyz", 3, kLargestNumber},
                                 NumberRule{"origin", "rpy", 3, kLargestNumber},
                                 NumberRule{"axis", "xyz", 3, kLargestNumber},
                                 NumberRule{"mass", "value", 1, kLargestNumber},
                                 NumberRule{"inertia", "ixx", 1, kLargestNumber},
                                 NumberRule{"inertia", "ixy", 1, kLargestNumber},
                                 NumberRule{"inertia", "ixz", 1, kLargestNumber},
                                 NumberRule{"inertia", "iyy", 1, kLargestNumber},
                                 NumberRule{"inertia", "iyz", 1, kLargestNumber},
                                 NumberRule{"inertia", "izz", 1, kLargestNumber},
                                 NumberRule{"limit", "lower", 1, kAnyNumber},
                                 NumberRule{"limit", "upper", 1, kAnyNumber},
                                 NumberRule{"limit", "velocity", 1, kAnyNumber},
                                 NumberRule{"limit", "effort", 1, kAnyNumber},
                                 NumberRule{"mimic", "multiplier", 1, kAnyNumber},
                                 NumberRule{"mimic", "offset", 1, kAnyNumber}};

bool is_kept(std::string_view parent, std::string_view element) {
  const auto one_of = [&](std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), element) != names.end();
  };
  if (parent == "robot") return one_of({"link", "joint"});
  if (parent == "link") return one_of({"inertial"});
  if (parent == "inertial") return one_of({"origin", "mass", "inertia"});
  if (parent == "joint") return one_of({"origin", "parent", "child", "axis", "limit", "mimic"});
  return false;
}

void append_escaped(std::string_view value, std::string& out) {
  for (const char c : value) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
}

class Reducer {
 public:
  explicit Reducer(std::string_view text) : reader_(text) {}

  UrdfText reduce() {
    while (reader_.next()) {
      if (reader_.is_start()) {
        start();
      } else {
        end();
      }
    }
    return std::move(result_);
  }

 private:
  void start() {
    const std::string name(reader_.name());
    if (reader_.depth() == 1) {
      if (name != "robot") reader_.fail("the root element is <" + name + ">, not <robot>");
    } else if (reader_.depth() != static_cast<int>(kept_.size()) + 1 ||
               !is_kept(kept_.back(), name)) {
      return;  // nothing below an element that is not kept is kept
    } else if (kept_.size() == 1) {
      start_element(name);
    } else if (!siblings_[kept_.size()].insert(name).second) {
      fail("has more than one <" + name + ">");
    }
    kept_.push_back(name);
    siblings_[kept_.size()].clear();
    write_start(name);
  }

  void end() {
    if (reader_.depth() != static_cast<int>(kept_.size())) return;
    if (kept_.back() == "inertial") {
      for (const char* part : {"mass", "inertia"}) {
        if (!siblings_[kept_.size()].contains(part)) {
          fail(std::string("its <inertial> has no <") + part + ">");
        }
      }
    }
    result_.xml += "</" + kept_.back() + ">\n";
    kept_.pop_back();
  }

  // A <link> or <joint>.
  void start_element(const std::string& kind) {
    if (++elements_ > kMaxElements) reader_.fail("more than 5000 links and joints");
    const auto& attributes = reader_.attributes();
    const auto found = std::find_if(attributes.begin(), attributes.end(),
                                    [](const XmlAttribute& a) { return a.name == "name"; });
    if (found == attributes.end() || found->value.empty()) reader_.fail(kind + " without a name");
    check_name(found->value);
    where_ = kind + " \"" + found->value + "\"";
    if (kind == "link") {
      result_.links.push_back(found->value);
    } else {
      result_.joints.push_back({found->value, {}, {}});
    }
  }

  void check_name(const std::string& value) {
    const bool control = std::any_of(value.begin(), value.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    });
    if (control || value.size() > kMaxNameLength || !is_utf8(value)) {
      reader_.fail("a name that is not UTF-8, too long or holds control characters");
    }
  }

  // Of <mass> and <inertia>: all their numbers.
  void check_complete(const std::string& element) {
    if (element != "mass" && element != "inertia") return;
    const auto& attributes = reader_.attributes();
    for (const NumberRule& rule : kNumbers) {
      const bool missing =
          rule.element == element &&
          std::none_of(attributes.begin(), attributes.end(),
                       [&](const XmlAttribute& a) { return a.name == rule.attribute; });
      if (missing) fail("its <" + element + "> has no " + std::string(rule.attribute));
    }
  }

  void write_start(const std::string& element) {
    check_complete(element);
    result_.xml += "<" + element;
    for (const XmlAttribute& attribute : reader_.attributes()) {
      const auto rule = std::find_if(kNumbers.begin(), kNumbers.end(), [&](const NumberRule& r) {
        return r.element == element && r.attribute == attribute.name;
      });
      const bool text = attribute.name == "name" || attribute.name == "type" ||
                        attribute.name == "link" || attribute.name == "joint";
      if (rule == kNumbers.end() && !text) {
        if (attribute.name == "quat_xyzw") fail("origin quat_xyzw is not supported, use rpy");
        continue;
      }
      result_.xml.append(" ").append(attribute.name).append("=\"");
      if (rule != kNumbers.end()) {
        append_numbers(*rule, attribute.value);
      } else {
        check_name(attribute.value);
        append_escaped(attribute.value, result_.xml);
        if (element == "parent" && attribute.name == "link") {
          result_.joints.back().parent = attribute.value;
        }
        if (element == "child" && attribute.name == "link") {
          result_.joints.back().child = attribute.value;
        }
      }
      result_.xml += '"';
    }
    result_.xml += ">\n";
  }

  void append_numbers(const NumberRule& rule, std::string_view value) {
    int count = 0;
    for (std::size_t i = value.find_first_not_of(' '); i != std::string_view::npos;
         i = value.find_first_not_of(' ', i)) {
      const std::size_t end = std::min(value.find(' ', i), value.size());
      if (count++ > 0) result_.xml += ' ';
      append_number(rule, value.substr(i, end - i));
      i = end;
    }
    if (count != rule.count) {
      fail(std::string(rule.element) + " " + std::string(rule.attribute) + " has " +
           std::to_string(count) + " numbers instead of " + std::to_string(rule.count));
    }
  }

  void append_number(const NumberRule& rule, std::string_view token) {
    const auto refuse = [&](const char* reason) {
      fail(std::string(rule.element) + " " + std::string(rule.attribute) + ": \"" +
           std::string(token.substr(0, 40)) + "\" is " + reason);
    };
    std::string_view digits = token;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double number = 0.0;
    const auto [last, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (last != digits.data() + digits.size() || error == std::errc::invalid_argument ||
        (digits.size() != token.size() && digits.starts_with('-'))) {
      refuse("not a number");
    }
    if (error != std::errc{} || !std::isfinite(number)) refuse("not a finite number");
    if (std::abs(number) > rule.largest) refuse("absurdly large");
    std::array<char, 32> buffer{};
    const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
    result_.xml.append(buffer.data(), written.ptr);
  }

  [[noreturn]] void fail(const std::string& reason) const { reader_.fail(where_ + ": " + reason); }

  XmlReader reader_;
  UrdfText result_;
  std::vector<std::string> kept_;                  // open elements that are kept
  std::array<std::set<std::string>, 6> siblings_;  // children seen so far, per depth of the parent
  std::string where_ = "robot";
  int elements_ = 0;
};

// urdfdom must not see a loop: it would never free its links.
class Tree {
 public:
  explicit Tree(const UrdfText& text) : text_(text) {
    for (const std::string& link : text.links) {
      if (!parents_.emplace(link, nullptr).second) fail("link", link, "is not unique");
    }
    std::set<std::string> names;
    for (const UrdfText::Joint& joint : text.joints) {
      if (!names.insert(joint.name).second) fail("joint", joint.name, "is not unique");
      add(joint);
    }
  }

  void check() const {
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
      // Up to what is known to hang on the root; a walk longer than the robot is a loop.
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

UrdfText reduce_urdf(std::string_view text) {
  if (text.size() > kMaxUrdfBytes) throw UrdfError("URDF: larger than 64 MiB");
  UrdfText reduced = Reducer(text).reduce();
  Tree(reduced).check();
  return reduced;
}

}  // namespace codesign::dynamics
