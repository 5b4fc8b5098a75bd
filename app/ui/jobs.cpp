#include "app/ui/jobs.h"

#include "codec/remote/consent.h"
#include "volume/base/error.h"

#include <algorithm>
#include <chrono>

namespace tessera::app {

struct Jobs::Job {
    std::string key, title;
    bool quiet = false;
    std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
    std::stop_source stop;
    std::jthread thread;
    std::function<Finish(const Progress&)> work;
    // Guarded by the mutex below.
    std::mutex mutex;
    double fraction = 0;
    std::string what;
    bool done = false;
    Finish finish;
    std::string failure;
    std::string machine; ///< that is not allowed
};

void Jobs::start(const std::string& key, const std::string& title, std::function<Finish(const Progress&)> work,
                 bool quiet) {
    if (!key.empty()) cancel(key);
    auto job = std::make_shared<Job>();
    job->key = key;
    job->title = title;
    job->quiet = quiet;
    job->work = std::move(work);
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(job);
    }
    job->thread = std::jthread([this, self = job.get()] {
        Progress progress;
        progress.stop = self->stop.get_token();
        progress.report = [self](double fraction, const std::string& what) {
            const std::lock_guard lock(self->mutex);
            self->fraction = std::clamp(fraction, 0.0, 1.0);
            if (!what.empty()) self->what = what;
        };
        Finish finish;
        std::string failure, machine;
        try {
            finish = self->work(progress);
        } catch (const codec::NotAllowed& error) {
            failure = error.what();
            machine = error.machine();
        } catch (const Cancelled&) {
            self->stop.request_stop();
        } catch (const std::bad_alloc&) {
            failure = "not enough memory";
        } catch (const std::exception& error) {
            failure = error.what();
        }
        {
            const std::lock_guard lock(self->mutex);
            self->finish = std::move(finish);
            self->failure = std::move(failure);
            self->machine = std::move(machine);
            self->done = true;
        }
        if (wake) wake();
    });
}

void Jobs::cancel(const std::string& key) {
    const std::lock_guard lock(mutex_);
    for (const auto& job : jobs_)
        if (job->key == key) job->stop.request_stop();
}

bool Jobs::running(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    return std::any_of(jobs_.begin(), jobs_.end(),
                       [&](const auto& job) { return job->key == key && !job->stop.stop_requested(); });
}

std::vector<Jobs::Status> Jobs::list() const {
    const std::lock_guard lock(mutex_);
    std::vector<Status> all;
    for (const auto& job : jobs_) {
        if (job->stop.stop_requested()) continue;
        const std::lock_guard inner(job->mutex);
        const auto age = std::chrono::duration<double>(std::chrono::steady_clock::now() - job->begin).count();
        all.push_back({job->key, job->title, job->what, job->fraction, age, job->quiet});
    }
    return all;
}

std::vector<std::string> Jobs::collect() {
    std::vector<std::shared_ptr<Job>> finished;
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(jobs_, [&](const auto& job) {
            const std::lock_guard inner(job->mutex);
            if (!job->done) return false;
            finished.push_back(job);
            return true;
        });
    }
    std::vector<std::string> messages;
    for (const auto& job : finished) {
        job->thread.join();
        if (job->stop.stop_requested()) continue; // cancelled: drop its result
        if (!job->machine.empty() && refused) {
            refused({job->title, job->machine,
                     [this, key = job->key, title = job->title, quiet = job->quiet, work = job->work] {
                         start(key, title, work, quiet);
                     }});
        } else if (!job->failure.empty()) {
            messages.push_back(job->title.empty() ? job->failure : job->title + ": " + job->failure);
        } else if (job->finish) {
            try {
                job->finish();
            } catch (const std::exception& error) {
                messages.push_back(error.what());
            }
        }
    }
    return messages;
}

void Jobs::wait() {
    std::vector<std::shared_ptr<Job>> all;
    {
        const std::lock_guard lock(mutex_);
        all = jobs_;
    }
    using namespace std::chrono_literals;
    for (const auto& job : all) {
        for (;;) {
            {
                const std::lock_guard inner(job->mutex);
                if (job->done) break;
            }
            std::this_thread::sleep_for(1ms);
        }
    }
}

Jobs::~Jobs() {
    std::vector<std::shared_ptr<Job>> all;
    {
        const std::lock_guard lock(mutex_);
        all.swap(jobs_);
    }
    for (const auto& job : all) job->stop.request_stop();
    for (const auto& job : all)
        if (job->thread.joinable()) job->thread.join();
}

} // namespace tessera::app
