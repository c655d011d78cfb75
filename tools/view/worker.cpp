#include "tools/view/worker.hpp"

#include "tools/view/studio.hpp"

namespace myriad::tools::view {

Worker::Worker(uint32_t divisor, std::function<void()> changed) : changed_(std::move(changed)), pace_(divisor), divisor_(pace_.divisor()), thread_([this] { run(); }) {}

Worker::~Worker() {
    {
        std::scoped_lock lock(mutex_);
        ends_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void Worker::want(Wish wish) {
    {
        std::scoped_lock lock(mutex_);
        wish_ = std::move(wish);
    }
    wake_.notify_all();
}

void Worker::save(std::string exr, std::string png, std::vector<std::string> layers) {
    {
        std::scoped_lock lock(mutex_);
        order_ = {std::move(exr), std::move(png), std::move(layers)};
    }
    wake_.notify_all();
}

std::shared_ptr<const Shown> Worker::shown() const {
    std::scoped_lock lock(mutex_);
    return shown_;
}

std::shared_ptr<const SceneFacts> Worker::facts() const {
    std::scoped_lock lock(mutex_);
    return facts_;
}

Status Worker::status() const {
    std::scoped_lock lock(mutex_);
    return status_;
}

void Worker::publish(std::shared_ptr<const Shown> shown) {
    {
        std::scoped_lock lock(mutex_);
        shown_ = std::move(shown);
    }
    changed_();
}

void Worker::tell(const std::function<void(Status&)>& change) {
    {
        std::scoped_lock lock(mutex_);
        change(status_);
    }
    changed_();
}

// A picture of something that moves is finished although the thing has moved on: else none would be, as long as it moves.
bool Worker::superseded(const Wish& wish) const {
    std::scoped_lock lock(mutex_);
    return ends_ || (wish_.number != wish.number && !(wish.moving && wish_.moving && wish.scene == wish_.scene));
}

void Worker::run() {
    std::unique_ptr<Studio> studio;
    std::string device;
    uint64_t done = 0;
    for (;;) {
        Wish wish;
        std::optional<Order> order;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return ends_ || wish_.number != done || (order_ && wish_.number); });
            if (ends_) return;
            wish = wish_;
            if (!wish.moving) order = std::exchange(order_, {});
        }
        std::string error;
        try {
            const auto text = [&](const char* name) { return wish.texts.contains(name) ? wish.texts.at(name) : std::string(); };
            const std::string select = text("--device") + "\n" + text("--memory-limit");
            if (!studio || device != select) {
                tell([](Status& s) { s.stage = "starting the device", s.done = 0; });
                studio.reset();
                studio = std::make_unique<Studio>(read(wish.scene, wish.texts)->device);
                device = select;
            }
            carry_out(*studio, wish, order);
        } catch (const Interrupted&) {
            std::scoped_lock lock(mutex_);
            if (order && !order_) order_ = order;  // of what comes next
            done = 0;
            continue;
        } catch (const OutOfMemory& e) {
            error = e.what();
        } catch (const DeviceError& e) {
            error = e.what();
            studio.reset();  // lost, perhaps; the next wish begins with a new one
        } catch (const std::exception& e) {
            error = e.what();
        }
        done = wish.number;
        tell([&](Status& s) {
            s.stage.clear(), s.error = error;
            if (studio) s.validation = studio->validation_messages();
        });
    }
}

void Worker::carry_out(Studio& studio, const Wish& wish, std::optional<Order> order) {
    const auto leave = [&] {
        if (superseded(wish)) throw Interrupted();
    };
    const Studio::Report report = [&](const std::string& stage, double part) {
        tell([&](Status& s) { s.stage = stage, s.done = part; });
        leave();
    };
    const auto whole = read(wish.scene, sized(wish.texts, wish.width, wish.height, 1));
    tell([&](Status& s) { s.stage = "loading " + wish.scene, s.done = 0, s.divisor = pace_.divisor(); });
    if (studio.open(*whole, wish.texts)) {
        {
            std::scoped_lock lock(mutex_);
            facts_ = std::make_shared<SceneFacts>(studio.facts());
        }
        changed_();
    }
    leave();
    if (const auto before = shown(); order && before && before->complete && before->wish == wish.number) return save(studio, wish, *order, before->exposure);
    if (!wish.moving) divisor_ = pace_.divisor();
    const Texts whole_texts = sized(wish.texts, wish.width, wish.height, 1);
    const std::vector<Texts> rungs = ladder(wish.scene, wish.texts, wish.width, wish.height, wish.moving, divisor_, studio.last_ms(whole_texts));
    for (const Texts& rung : rungs) {
        const bool last = &rung == &rungs.back(), exact = last && !wish.moving, first_of_its_kind = studio.last_ms(rung) == 0;
        const auto shown = studio.render(rung, *read(wish.scene, rung), exact, report);
        shown->wish = wish.number, shown->complete = exact, shown->since = wish.since;
        if (&rung == &rungs.front() && !exact && !first_of_its_kind && pace_.measured(divisor_, shown->ms) && shown->ms > 2 * Pace::most_ms) divisor_ = pace_.divisor();
        publish(shown);
        if (!last) leave();
        if (exact && order) save(studio, wish, *order, shown->exposure);
    }
}

void Worker::save(Studio& studio, const Wish& wish, const Order& order, double exposure) {
    const auto options = read(wish.scene, sized(wish.texts, wish.width, wish.height, 1));
    options->exr = order.exr, options->png = order.png;
    if (!order.exr.empty()) options->layers = order.layers;
    check_outputs(*options);
    studio.save(*options, exposure);
    tell([&](Status& s) { s.note = "wrote " + (order.exr.empty() ? order.png : order.exr); });
}

}  // namespace myriad::tools::view
