#include "app/dialogs/file_questions.h"

#include <utility>

namespace tessera::app {

namespace {

constexpr const char* kData = "data"; ///< the purpose of a question whose files must be readable

} // namespace

FileQuestions::FileQuestions(Jobs& jobs) : form_(jobs) {
    dialog_.preview = [this](const std::string& path) {
        FilePreview preview = form_.previewOf(path);
        // Other purposes are files that are not data (colour maps), or data whose layout a session states.
        preview.failed = preview.failed && dialog_.purpose() == kData;
        return preview;
    };
    dialog_.filesChosen = [this](const std::vector<std::string>& paths) { form_.filesChosen(paths); };
}

void FileQuestions::askData(const std::string& title,
                            std::function<void(const std::vector<std::string>&, const volume::ImportOptions&)> answer) {
    answer_ = [this, answer = std::move(answer)](const auto& paths) { answer(paths, form_.stated()); };
    dialog_.options = [this] { form_.draw(); };
    dialog_.show(FileMode::Open, title, kData, dialog_.folder());
}

bool FileQuestions::asksData() const {
    return dialog_.shown() && dialog_.purpose() == kData;
}

void FileQuestions::askOpen(const std::string& title, std::function<void(const std::vector<std::string>&)> answer,
                            const std::string& folder) {
    answer_ = std::move(answer);
    dialog_.options = nullptr; // nothing can be stated of files that are not imported
    dialog_.show(FileMode::Open, title, "", folder.empty() ? dialog_.folder() : folder);
}

void FileQuestions::askSave(const std::string& title, const std::string& name, const std::string& ending,
                            std::function<void(const std::string&)> answer) {
    answer_ = [answer = std::move(answer)](const std::vector<std::string>& paths) { answer(paths.front()); };
    dialog_.show(FileMode::Save, title, "", dialog_.folder(), name, ending);
}

void FileQuestions::draw() {
    if (const auto answer = dialog_.draw(); answer && answer_) {
        std::exchange(answer_, nullptr)(answer->paths); // may ask again
        return;
    }
    if (!dialog_.shown()) answer_ = nullptr;
}

} // namespace tessera::app
