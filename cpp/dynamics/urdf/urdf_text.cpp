#include "dynamics/urdf/urdf_text.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "dynamics/spatial.hpp"
#include "dynamics/urdf/rules.hpp"
#include "dynamics/urdf/urdf_tree.hpp"
#include "errors.hpp"

namespace codesign::dynamics {
namespace {

constexpr int kMaxElements = 5000;  // links and joints
constexpr std::size_t kMaxNameLength = 1000;
constexpr double kSmallestQuaternion = 1e-6;

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

// In every locale the same, and read back exactly.
std::string text_of(double number) {
  std::array<char, 32> buffer{};
  const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), written.ptr};
}

std::string in_quotes(std::string_view text) {
  std::string quoted(1, '"');
  return quoted.append(text.substr(0, 40)).append(1, '"');
}

class Reducer : public XmlListener {
 public:
  explicit Reducer(UrdfScope scope) : scope_(scope) {}

  void start(std::string_view name, const std::vector<XmlAttribute>& attributes) override {
    ++depth_;
    start_element(std::string(name), attributes);
  }

  void end() override {
    if (depth_-- != open_.size()) return;
    const Open element = std::move(open_.back());
    open_.pop_back();
    end_element(element);
  }

  UrdfText result() && { return std::move(result_); }

 private:
  struct Open {
    std::string name;
    bool written;                    // into the reduced text
    std::set<std::string> children;  // that were read
  };
  using Numbers = std::map<std::string_view, std::vector<double>>;  // by attribute

  // An element that is refused is left out with all that is in it.
  void start_element(const std::string& element, const std::vector<XmlAttribute>& attributes) {
    if (depth_ == 1) {
      if (element != "robot") fail("the root element is <" + element + ">, not <robot>");
      if (find(attributes, "name").empty()) fail("<robot> has no name");
    } else if (depth_ != open_.size() + 1) {
      return;  // below an element that nobody reads
    } else if (!is_read(open_.back().name, element, scope_)) {
      if (open_.back().name == "geometry") {
        no_shape_ = element;
      }
      return;
    } else if (depth_ == 2) {
      start_link_or_joint(element, attributes);
    } else {
      check_siblings(element);
    }
    const bool written = depth_ == 1 || (open_.back().written && !is_shape(element));
    if (element == "geometry") no_shape_.clear();
    open_.push_back({element, written, {}});
    read_element(element, attributes);
  }

  void end_element(const Open& element) {
    if (element.name == "inertial") require_children(element, {"mass", "inertia"});
    if (is_shape(element.name)) require_children(element, {"geometry"});
    if (element.name == "geometry" && element.children.empty()) {
      fail((no_shape_.empty() ? "its <geometry> is empty: " : "<" + no_shape_ + "> is no shape: ") +
           std::string(kShapeWords));
    }
    if (element.name == "joint" && needs_limits(type_) && !element.children.contains("limit")) {
      fail("a " + type_ + " joint needs limits, <limit> is missing");
    }
    if (element.written) result_.xml += "</" + element.name + ">\n";
  }

  static std::string_view find(const std::vector<XmlAttribute>& attributes, std::string_view name) {
    for (const XmlAttribute& attribute : attributes) {
      if (attribute.name == name) return attribute.value;
    }
    return {};
  }

  void start_link_or_joint(const std::string& kind, const std::vector<XmlAttribute>& attributes) {
    where_.clear();
    if (++elements_ > kMaxElements) fail("more than 5000 links and joints");
    const std::string name(find(attributes, "name"));
    if (name.empty()) fail(kind + " without a name");
    check_name(name);
    where_ = kind + " \"" + name + "\": ";
    if (kind == "link") {
      result_.links.push_back(name);
      return;
    }
    result_.joints.push_back({name, {}, {}});
    type_ = find(attributes, "type");
    if (std::find(kJointTypes.begin(), kJointTypes.end(), type_) == kJointTypes.end()) {
      std::string types;
      for (const std::string_view type : kJointTypes) {
        types.append(types.empty() ? "" : ", ").append(type);
      }
      fail((type_.empty() ? "it has no type" : "its type " + in_quotes(type_) + " is unknown") +
           ": one of " + types);
    }
  }

  void check_siblings(const std::string& element) {
    std::set<std::string>& siblings = open_.back().children;
    if (open_.back().name == "geometry" && !siblings.empty()) fail("<geometry> with two shapes");
    if (!siblings.insert(element).second && !is_shape(element)) {
      fail("has more than one <" + element + ">");
    }
  }

  void require_children(const Open& element, Names names) const {
    for (const std::string_view name : names) {
      if (element.children.contains(std::string(name))) continue;
      fail("its <" + element.name + "> has no <" + std::string(name) + ">");
    }
  }

  void check_name(std::string_view value) const {
    const bool control = std::any_of(value.begin(), value.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    });
    if (control || value.size() > kMaxNameLength) {
      fail("a name that is too long or holds control characters");
    }
  }

  void read_element(const std::string& element, const std::vector<XmlAttribute>& attributes) {
    if (element == "mesh" && find(attributes, "filename").empty()) {
      fail("its <mesh> has no filename");
    }
    Numbers numbers;
    for (const NumberRule& rule : kNumbers) {
      if (rule.element != element) continue;
      const auto found = std::find_if(attributes.begin(), attributes.end(),
                                      [&](const auto& a) { return a.name == rule.attribute; });
      if (found != attributes.end()) {
        numbers[rule.attribute] = read_numbers(rule, found->value);
      } else if (rule.required) {
        fail("its <" + element + "> has no " + std::string(rule.attribute));
      }
    }
    check_joint(element, numbers);
    if (element == "origin") read_quaternion(numbers);
    if (open_.back().written) write_start(element, attributes, numbers);
  }

  // A rotation given as a quaternion becomes fixed-axis angles, which any parser reads.
  void read_quaternion(Numbers& numbers) const {
    const auto found = numbers.find("quat_xyzw");
    if (found == numbers.end()) return;
    if (numbers.contains("rpy")) fail("its <origin> has both rpy and quat_xyzw");
    const std::vector<double>& q = found->second;
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    if (!(rotation.norm() > kSmallestQuaternion)) fail("origin quat_xyzw: of length zero");
    const Eigen::Vector3d rpy = rotation_to_rpy(rotation.normalized().toRotationMatrix());
    numbers["rpy"] = {rpy[0], rpy[1], rpy[2]};
    numbers.erase(found);
  }

  // Axis and limits of a joint.
  void check_joint(std::string_view element, const Numbers& numbers) const {
    if (element == "axis" && has_axis(type_) && numbers.contains("xyz")) {
      const std::vector<double>& axis = numbers.at("xyz");
      if (axis == std::vector<double>(3, 0.0)) fail("an axis of length zero");
    }
    if (element != "limit" || !needs_limits(type_)) return;
    const auto value = [&](std::string_view name) {
      return numbers.contains(name) ? numbers.at(name).front() : 0.0;
    };
    if (value("lower") > value("upper")) {
      fail("its lower limit " + text_of(value("lower")) + " is above its upper limit " +
           text_of(value("upper")));
    }
  }

  void write_start(const std::string& element, const std::vector<XmlAttribute>& attributes,
                   const Numbers& numbers) {
    result_.xml += "<" + element;
    const bool turned = std::none_of(attributes.begin(), attributes.end(),
                                     [](const auto& a) { return a.name == "rpy"; });
    if (element == "origin" && turned && numbers.contains("rpy")) {
      write_numbers("rpy", numbers.at("rpy"));
    }
    for (const auto& [name, value] : attributes) {
      const auto found = numbers.find(name);
      if (found == numbers.end() && !one_of(name, {"name", "type", "link", "joint"})) continue;
      if (found != numbers.end()) {
        write_numbers(name, found->second);
        continue;
      }
      check_name(value);
      result_.xml.append(" ").append(name).append("=\"");
      append_escaped(value, result_.xml);
      result_.xml += '"';
    }
    result_.xml += ">\n";
    if (element == "parent") result_.joints.back().parent = find(attributes, "link");
    if (element == "child") result_.joints.back().child = find(attributes, "link");
  }

  void write_numbers(std::string_view name, const std::vector<double>& numbers) {
    result_.xml.append(" ").append(name).append("=\"");
    const char* separator = "";
    for (const double number : numbers) {
      result_.xml.append(separator).append(text_of(number));
      separator = " ";
    }
    result_.xml += '"';
  }

  std::vector<double> read_numbers(const NumberRule& rule, std::string_view value) const {
    std::vector<double> numbers;
    for (std::size_t i = value.find_first_not_of(' '); i != std::string_view::npos;
         i = value.find_first_not_of(' ', i)) {
      const std::size_t end = std::min(value.find(' ', i), value.size());
      numbers.push_back(read_number(rule, value.substr(i, end - i)));
      i = end;
    }
    const auto count = static_cast<int>(numbers.size());
    if (count != rule.count && !(rule.one_will_do && count == 1)) {
      fail(name_of(rule) + " has " + std::to_string(count) + " numbers instead of " +
           (rule.one_will_do ? "1 or " : "") + std::to_string(rule.count));
    }
    return numbers;
  }

  double read_number(const NumberRule& rule, std::string_view token) const {
    const auto refuse = [&](const std::string& reason) {
      fail(name_of(rule) + ": " + in_quotes(token) + " is " + reason);
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
    if (std::abs(number) > rule.largest) refuse("above the limit of " + text_of(rule.largest));
    if (rule.not_negative && number < 0.0) refuse("below zero");
    return number;
  }

  static std::string name_of(const NumberRule& rule) {
    return std::string(rule.element) + " " + std::string(rule.attribute);
  }

  [[noreturn]] void fail(const std::string& reason) const { throw UrdfError(where_ + reason); }

  UrdfScope scope_;
  UrdfText result_;
  std::size_t depth_ = 0;   // of the current element; the root has 1
  std::vector<Open> open_;  // the elements down to it that are read
  std::string where_;       // the current link or joint
  std::string type_;        // of the current joint
  std::string no_shape_;    // last element of the current geometry that is none
  int elements_ = 0;
};

}  // namespace

UrdfText reduce_urdf(std::string_view text, XmlEncoding encoding, UrdfScope scope) {
  if (text.size() > kMaxUrdfBytes) throw UrdfError("URDF: larger than 64 MiB");
  Reducer reducer(scope);
  read_xml(text, encoding, reducer);
  UrdfText reduced = std::move(reducer).result();
  reduced.root = root_of_tree(reduced);
  return reduced;
}

}  // namespace codesign::dynamics
