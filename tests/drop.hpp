// Drops a file on a window, as a file manager does: XDND, version 5 (https://freedesktop.org/wiki/Specifications/XDND). Tests only.
#pragma once

#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <chrono>
#include <cstring>
#include <string>
#include <thread>

namespace myriad::tools {

class Drop {
public:
    explicit Drop(const std::string& display) : display_(XOpenDisplay(display.c_str())) {
        if (display_) source_ = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 8, 8, 0, 0, 0);
    }
    ~Drop() {
        if (display_) XCloseDisplay(display_);
    }
    Drop(const Drop&) = delete;

    // Whether the window took it.
    bool onto(Window target, const std::string& path) {
        if (!display_) return false;
        uris_ = "file://" + path + "\r\n";
        XSetSelectionOwner(display_, atom("XdndSelection"), source_, CurrentTime);
        send(target, "XdndEnter", {long(source_), 5l << 24, long(atom("text/uri-list")), 0, 0});
        int x = 0, y = 0;
        Window child = 0;
        XTranslateCoordinates(display_, target, DefaultRootWindow(display_), 20, 20, &x, &y, &child);
        send(target, "XdndPosition", {long(source_), 0, long(x) << 16 | y, CurrentTime, long(atom("XdndActionCopy"))});
        if (!hear("XdndStatus")) return false;
        send(target, "XdndDrop", {long(source_), 0, CurrentTime, 0, 0});
        return hear("XdndFinished");
    }

private:
    Atom atom(const char* name) { return XInternAtom(display_, name, False); }

    void send(Window target, const char* what, std::initializer_list<long> data) {
        XEvent event{};
        event.xclient = {.type = ClientMessage, .window = target, .message_type = atom(what), .format = 32};
        std::copy(data.begin(), data.end(), event.xclient.data.l);
        XSendEvent(display_, target, False, NoEventMask, &event);
        XFlush(display_);
    }

    // Waits for that message, and hands the list of files over to who asks meanwhile.
    bool hear(const char* what) {
        for (int i = 0; i < 2000; ++i) {
            while (XPending(display_)) {
                XEvent event;
                XNextEvent(display_, &event);
                if (event.type == SelectionRequest) hand_over(event.xselectionrequest);
                if (event.type == ClientMessage && event.xclient.message_type == atom(what)) return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    void hand_over(const XSelectionRequestEvent& request) {
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(uris_.data()), int(uris_.size()));
        XEvent event{};
        event.xselection = {.type = SelectionNotify, .requestor = request.requestor, .selection = request.selection, .target = request.target,
                            .property = request.property, .time = request.time};
        XSendEvent(display_, request.requestor, False, NoEventMask, &event);
        XFlush(display_);
    }

    Display* display_;
    Window source_ = 0;
    std::string uris_;
};

}  // namespace myriad::tools
