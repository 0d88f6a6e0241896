#include "io/text/xml_parser.h"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <new>
#include <unordered_set>

#include "io/text/entry_limit.h"
#include "io/text/hints.h"
#include "libreeb/base/error.h"

namespace reeb::io {

std::string attribute_of(const XmlAttributes& attributes, std::string_view name) {
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return {};
}

struct XmlParser::State {
  // Expat holds a tag or a comment until it is whole.
  static constexpr std::uint64_t kMostHeld = std::uint64_t{1} << 20;
  static constexpr std::size_t kStepBytes = ContentSource::kLookahead;

  ContentSource* source = nullptr;
  Handler* handler = nullptr;
  XML_Parser parser = nullptr;
  std::uint64_t offset = 0, view_offset = 0;
  bool ended = false;
  std::exception_ptr failure;  // Expat is in C, so an exception must not pass through it
  bool has_document_type = false;
  // Expat holds the tags around it, and every name that it has met.
  EntryLimit open_tags{"tags inside each other", 100}, names{"different names of tags and attributes"};
  std::unordered_set<std::string> known_names;

  [[noreturn]] void fail(const std::string& what, const std::string& hint) const {
    throw Error(ErrorKind::kBadInput, what, hint)
        .at(source->name(), std::to_string(XML_GetCurrentLineNumber(parser)) + ":" +
                                std::to_string(XML_GetCurrentColumnNumber(parser) + 1));
  }

  void meet_name(const std::string& name) {
    if (known_names.contains(name)) return;
    names.add(1, name.size(), *this);
    known_names.insert(name);
  }

  template <class Call>
  void guarded(const Call& call) {
    if (ended) return;
    try {
      ended = !call();
    } catch (...) {
      failure = std::current_exception();
      ended = true;
    }
    if (ended) XML_StopParser(parser, XML_FALSE);
  }

  static void on_start(void* user, const char* name, const char** list) {
    auto* const state = static_cast<State*>(user);
    state->guarded([&] {
      XmlAttributes attributes;
      for (; *list != nullptr; list += 2) {
        attributes.emplace_back(list[0], list[1]);
        state->meet_name(attributes.back().first);
      }
      const std::string tag(name);
      state->open_tags.add(1, tag.size(), *state);
      state->meet_name(tag);
      return state->handler->start(tag, attributes);
    });
  }
  static void on_end(void* user, const char* name) {
    auto* const state = static_cast<State*>(user);
    state->guarded([&] {
      const std::string tag(name);
      state->open_tags.remove(tag.size());
      return state->handler->end(tag);
    });
  }
  static void on_text(void* user, const char* text, int length) {
    auto* const state = static_cast<State*>(user);
    state->guarded([&] { return state->handler->text({text, static_cast<std::size_t>(length)}); });
  }
  // Entities can stand for very much text, and no file of VTK has them.
  static void on_document_type(void* user, const char*, const char*, const char*, int) {
    auto* const state = static_cast<State*>(user);
    state->has_document_type = true;
    state->guarded([] { return false; });
  }
};

XmlParser::XmlParser(ContentSource& source, Handler& handler) : state_(std::make_unique<State>()) {
  state_->source = &source;
  state_->handler = &handler;
  state_->parser = XML_ParserCreate(nullptr);
  if (state_->parser == nullptr) throw std::bad_alloc();
  XML_SetUserData(state_->parser, state_.get());
  XML_SetElementHandler(state_->parser, &State::on_start, &State::on_end);
  XML_SetCharacterDataHandler(state_->parser, &State::on_text);
  XML_SetStartDoctypeDeclHandler(state_->parser, &State::on_document_type);
}

XmlParser::~XmlParser() { XML_ParserFree(state_->parser); }

bool XmlParser::advance() {
  State& state = *state_;
  if (state.ended) return false;
  state.view_offset = state.offset;
  const std::string_view view = state.source->view(state.offset).substr(0, State::kStepBytes);
  state.offset += view.size();
  const bool is_last = view.empty();
  const auto status = XML_Parse(state.parser, view.data(), static_cast<int>(view.size()), is_last ? 1 : 0);
  if (state.failure) std::rethrow_exception(state.failure);
  if (state.has_document_type) fail("a document type is not read", "remove it from the file");
  if (state.ended) return false;
  if (status != XML_STATUS_OK) {
    if (XML_GetErrorCode(state.parser) == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
    fail(std::string("this is not valid XML: ") + XML_ErrorString(XML_GetErrorCode(state.parser)), kCutOrDamagedHint);
  }
  const auto done = static_cast<std::uint64_t>(std::max<XML_Index>(XML_GetCurrentByteIndex(state.parser), 0));
  if (state.offset - std::min(done, state.offset) > State::kMostHeld + State::kStepBytes)
    fail("a tag or a comment of more than 1 MB", kDamagedHereHint);
  state.ended = is_last;
  return !is_last;
}

std::uint64_t XmlParser::offset() const { return state_->offset; }
std::uint64_t XmlParser::view_offset() const { return state_->view_offset; }
std::uint64_t XmlParser::line() const { return XML_GetCurrentLineNumber(state_->parser); }
std::uint64_t XmlParser::part_end() const {
  return static_cast<std::uint64_t>(XML_GetCurrentByteIndex(state_->parser)) +
         static_cast<std::uint64_t>(XML_GetCurrentByteCount(state_->parser));
}

void XmlParser::fail(const std::string& what, const std::string& hint) const { state_->fail(what, hint); }

}  // namespace reeb::io
