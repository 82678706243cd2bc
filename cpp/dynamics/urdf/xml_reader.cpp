#include "dynamics/urdf/xml_reader.hpp"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <type_traits>

#include "errors.hpp"

namespace codesign::dynamics {
namespace {

constexpr std::size_t kMaxDepth = 100;
constexpr int kMostFaults = 20;  // in a message
constexpr std::size_t kExcerptLength = 30;

class Parsing {
 public:
  Parsing(std::string_view text, const char* encoding, XmlListener& listener)
      : parser_(XML_ParserCreate(encoding)), text_(text), listener_(listener) {
    if (parser_ == nullptr) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), &Parsing::on_start, &Parsing::on_end);
    XML_SetStartDoctypeDeclHandler(parser_.get(), &Parsing::on_doctype);
  }

  // False if the encoding that the text declares is none that expat knows; nothing is heard then.
  bool read() {
    const auto begin = std::min(text_.find_first_not_of(" \t\r\n"), text_.size());
    lines_before_ = std::count(text_.begin(), text_.begin() + static_cast<long>(begin), '\n');
    text_.remove_prefix(begin);
    const auto status =
        XML_Parse(parser_.get(), text_.data(), static_cast<int>(text_.size()), XML_TRUE);
    if (failure_) std::rethrow_exception(failure_);
    if (status == XML_STATUS_OK) {
      if (!faults_.empty()) throw UrdfError(faults_);
      return true;
    }
    if (XML_GetErrorCode(parser_.get()) == XML_ERROR_UNKNOWN_ENCODING) return false;
    throw UrdfError((faults_.empty() ? "" : faults_ + "; ") + where() + reason());
  }

 private:
  struct Free {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };

  // Calls back from expat, which is C: no exception may pass through it.
  template <typename Action>
  static void guarded(void* user, Action action) {
    Parsing& self = *static_cast<Parsing*>(user);
    if (self.failure_) return;
    try {
      action(self);
      return;
    } catch (const UrdfError& e) {
      self.failure_ = std::make_exception_ptr(UrdfError(self.where() + e.what()));
    } catch (...) {
      self.failure_ = std::current_exception();
    }
    XML_StopParser(self.parser_.get(), XML_FALSE);
  }

  // What the listener refuses below the root element is kept, and reading goes on.
  template <typename Action>
  void collect(Action action) {
    try {
      action();
    } catch (const UrdfError& e) {
      if (faults_.empty() && open_.size() <= 1 && !below_root_) throw;
      faults_ += (faults_.empty() ? "" : "; ") + where() + e.what();
      if (++fault_count_ < kMostFaults) return;
      failure_ = std::make_exception_ptr(UrdfError(faults_ + "; and perhaps more"));
      XML_StopParser(parser_.get(), XML_FALSE);
    }
    below_root_ = true;
  }

  static void XMLCALL on_start(void* user, const char* name, const char** attributes) {
    guarded(user, [&](Parsing& self) {
      if (self.open_.size() >= kMaxDepth) throw UrdfError("elements nested more than 100 deep");
      self.open_.emplace_back(name);
      self.attributes_.clear();
      for (; *attributes != nullptr; attributes += 2) {
        self.attributes_.push_back({attributes[0], attributes[1]});
      }
      self.collect([&] { self.listener_.start(name, self.attributes_); });
    });
  }

  static void XMLCALL on_end(void* user, const char*) {
    guarded(user, [](Parsing& self) {
      self.open_.pop_back();
      self.collect([&] { self.listener_.end(); });
    });
  }

  static void XMLCALL on_doctype(void* user, const char*, const char*, const char*, int) {
    guarded(user, [](Parsing&) { throw UrdfError("document type declarations are refused"); });
  }

  std::string where() const {
    const auto line = static_cast<long>(XML_GetCurrentLineNumber(parser_.get())) + lines_before_;
    return (faults_.empty() ? "URDF line " : "line ") + std::to_string(line) + ": ";
  }

  std::string reason() const {
    const XML_Error code = XML_GetErrorCode(parser_.get());
    if (code == XML_ERROR_NO_ELEMENTS && !open_.empty())
      return "the text ends inside <" + open_.back() + ">";
    std::string reason = XML_ErrorString(code);
    if (const std::string found = excerpt(); !found.empty()) reason += " at `" + found + "`";
    if (!open_.empty()) reason += " inside <" + open_.back() + ">";
    return reason;
  }

  // The text that expat refuses, as far as it can be printed on one line.
  std::string excerpt() const {
    const auto index = XML_GetCurrentByteIndex(parser_.get());
    if (index < 0 || static_cast<std::size_t>(index) >= text_.size()) return {};
    std::string_view rest = text_.substr(static_cast<std::size_t>(index), kExcerptLength);
    rest = rest.substr(0, rest.find_first_of("\r\n"));
    std::string result(rest);
    std::replace_if(
        result.begin(), result.end(), [](char c) { return c < 0x20 || c > 0x7E; }, '?');
    return result;
  }

  std::unique_ptr<std::remove_pointer_t<XML_Parser>, Free> parser_;
  std::string_view text_;
  XmlListener& listener_;
  std::vector<XmlAttribute> attributes_;
  std::vector<std::string> open_;
  std::exception_ptr failure_;
  std::string faults_;
  int fault_count_ = 0;
  bool below_root_ = false;  // the root element has been taken
  long lines_before_ = 0;
};

}  // namespace

void read_xml(std::string_view text, XmlEncoding encoding, XmlListener& listener) {
  constexpr const char* kUtf8 = "UTF-8";
  const bool declared = encoding == XmlEncoding::kDeclared;
  if (Parsing(text, declared ? nullptr : kUtf8, listener).read()) return;
  Parsing(text, kUtf8, listener).read();  // such as "utf8"; what is not UTF-8 is refused
}

}  // namespace codesign::dynamics
