#include "engine/swapchain.hpp"

#include <algorithm>
#include <string>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace myriad::engine {
namespace {

template <class T, class List>
std::vector<T> listed(List list) {
    uint32_t count = 0;
    check(list(&count, nullptr), "asking what a window can show");
    std::vector<T> all(count);
    check(list(&count, all.data()), "asking what a window can show");
    all.resize(count);
    return all;
}

// Eight bits a channel, to be taken as they are: what is shown has been encoded already.
VkSurfaceFormatKHR pick_format(const std::vector<VkSurfaceFormatKHR>& formats) {
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
    throw DeviceError("the window shows no 8-bit sRGB pictures; use another device with --device");
}

uint blue_first(uint rgba) { return (rgba & 0xff00ff00u) | (rgba >> 16 & 0xffu) | (rgba & 0xffu) << 16; }

}  // namespace

Swapchain::Swapchain(Device& device, const Window& window) : device_(device), window_(window) {
    check(glfwCreateWindowSurface(device.instance(), window.handle(), nullptr, &surface_), "connecting the window and the device");
    try {
        VkBool32 shows = VK_FALSE;
        check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queue_family(), surface_, &shows), "asking what a window can show");
        if (!shows) throw DeviceError("device \"" + device.info().name + "\" cannot show pictures in this window; use another with --device");
        format_ = pick_format(listed<VkSurfaceFormatKHR>([&](uint32_t* count, VkSurfaceFormatKHR* out) {
            return vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), surface_, count, out);
        }));
        const auto modes = listed<VkPresentModeKHR>([&](uint32_t* count, VkPresentModeKHR* out) {
            return vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface_, count, out);
        });
        if (std::ranges::count(modes, VK_PRESENT_MODE_MAILBOX_KHR)) mode_ = VK_PRESENT_MODE_MAILBOX_KHR;  // the newest picture, without a queue of old ones

        VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        check(vkCreateSemaphore(device.handle(), &semaphore, nullptr, &acquired_), "creating a semaphore");
        VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        pool.queueFamilyIndex = device.queue_family();
        check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "creating a command pool");
        VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        allocate.commandPool = pool_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device.handle(), &allocate, &commands_), "allocating a command buffer");
        VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
        check(vkCreateFence(device.handle(), &fence, nullptr, &done_), "creating a fence");
        device.set_name(VK_OBJECT_TYPE_SEMAPHORE, reinterpret_cast<uint64_t>(acquired_), "window image acquired");
        device.set_name(VK_OBJECT_TYPE_COMMAND_POOL, reinterpret_cast<uint64_t>(pool_), "window");
        device.set_name(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<uint64_t>(commands_), "window");
        device.set_name(VK_OBJECT_TYPE_FENCE, reinterpret_cast<uint64_t>(done_), "window picture copied");
    } catch (...) {
        drop();
        throw;
    }
}

Swapchain::~Swapchain() {
    vkQueueWaitIdle(device_.queue());
    drop();
}

void Swapchain::drop() {
    for (VkSemaphore semaphore : drawn_) vkDestroySemaphore(device_.handle(), semaphore, nullptr);
    vkDestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
    vkDestroyFence(device_.handle(), done_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
    vkDestroySemaphore(device_.handle(), acquired_, nullptr);
    vkDestroySurfaceKHR(device_.instance(), surface_, nullptr);
}

Swapchain::Size Swapchain::size() {
    VkSurfaceCapabilitiesKHR can;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &can), "asking for the window's size");
    Size size{can.currentExtent.width, can.currentExtent.height};
    if (size.width == ~0u) {  // the window follows the picture (Wayland)
        const auto [width, height] = window_.pixels();
        size = {std::clamp(width, can.minImageExtent.width, can.maxImageExtent.width), std::clamp(height, can.minImageExtent.height, can.maxImageExtent.height)};
        if (width == 0 || height == 0) size = {};
    }
    if (size.empty()) return size;
    if (stale_ || size != size_) make(size);
    return size_;
}

void Swapchain::make(Size size) {
    VkSurfaceCapabilitiesKHR can;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &can), "asking for the window's size");
    if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) throw DeviceError("nothing can be copied to the window; use another device with --device");
    check(vkQueueWaitIdle(device_.queue()), "waiting for the window");
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = can.maxImageCount ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = {size.width, size.height};
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = mode_;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    const VkResult result = vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &made);
    vkDestroySwapchainKHR(device_.handle(), std::exchange(swapchain_, made), nullptr);
    size_ = {};
    check(result, "creating the window's images");
    device_.set_name(VK_OBJECT_TYPE_SWAPCHAIN_KHR, reinterpret_cast<uint64_t>(swapchain_), "window");
    images_ = listed<VkImage>([&](uint32_t* count, VkImage* out) { return vkGetSwapchainImagesKHR(device_.handle(), swapchain_, count, out); });
    for (VkSemaphore semaphore : drawn_) vkDestroySemaphore(device_.handle(), semaphore, nullptr);
    drawn_.assign(images_.size(), VK_NULL_HANDLE);
    VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (size_t i = 0; i < images_.size(); ++i) {
        check(vkCreateSemaphore(device_.handle(), &semaphore, nullptr, &drawn_[i]), "creating a semaphore");
        device_.set_name(VK_OBJECT_TYPE_SEMAPHORE, reinterpret_cast<uint64_t>(drawn_[i]), "window image drawn " + std::to_string(i));
        device_.set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(images_[i]), "window image " + std::to_string(i));
    }
    staging_ = {};
    staging_ = Array<uint>(device_, "window", "picture for the window", uint64_t(size.width) * size.height, Location::host);
    size_ = size;
    stale_ = false;
}

bool Swapchain::show(std::span<const uint32_t> picture) {
    assert(picture.size() == uint64_t(size_.width) * size_.height && !stale_);
    // The copy before has ended: staging, commands and semaphore are free.
    check(vkWaitForFences(device_.handle(), 1, &done_, VK_TRUE, UINT64_MAX), "waiting for the window");
    uint32_t index = 0;
    const VkResult acquired = vkAcquireNextImageKHR(device_.handle(), swapchain_, UINT64_MAX, acquired_, VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return stale_ = true, false;
    check(acquired, "acquiring an image of the window");
    if (format_.format == VK_FORMAT_B8G8R8A8_UNORM) std::ranges::transform(picture, staging_.span().begin(), blue_first);
    else std::ranges::copy(picture, staging_.span().begin());

    check(vkResetFences(device_.handle(), 1, &done_), "resetting a fence");
    check(vkResetCommandPool(device_.handle(), pool_, 0), "resetting a command pool");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &begin), "beginning a command buffer");
    device_.begin_label(commands_, "window");
    const auto transition = [&](VkImageLayout from, VkImageLayout to, VkAccessFlags2 before, VkAccessFlags2 after) {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        barrier.srcAccessMask = before, barrier.dstAccessMask = after;
        barrier.oldLayout = from, barrier.newLayout = to;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = images_[index];
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        dependency.imageMemoryBarrierCount = 1;
        dependency.pImageMemoryBarriers = &barrier;
        vkCmdPipelineBarrier2(commands_, &dependency);
    };
    transition(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {size_.width, size_.height, 1};
    vkCmdCopyBufferToImage(commands_, staging_.handle(), images_[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    transition(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT, 0);
    device_.end_label(commands_);
    check(vkEndCommandBuffer(commands_), "ending a command buffer");

    VkSemaphoreSubmitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO}, signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    wait.semaphore = acquired_, wait.stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    signal.semaphore = drawn_[index], signal.stageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = commands_;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.waitSemaphoreInfoCount = submit.commandBufferInfoCount = submit.signalSemaphoreInfoCount = 1;
    submit.pWaitSemaphoreInfos = &wait, submit.pCommandBufferInfos = &commands, submit.pSignalSemaphoreInfos = &signal;
    check(vkQueueSubmit2(device_.queue(), 1, &submit, done_), "submitting a picture");
    VkPresentInfoKHR present{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    present.waitSemaphoreCount = present.swapchainCount = 1;
    present.pWaitSemaphores = &drawn_[index], present.pSwapchains = &swapchain_, present.pImageIndices = &index;
    const VkResult presented = vkQueuePresentKHR(device_.queue(), &present);
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR || acquired == VK_SUBOPTIMAL_KHR) stale_ = true;
    if (presented == VK_ERROR_OUT_OF_DATE_KHR) return false;
    check(presented, "showing a picture");
    return true;
}

}  // namespace myriad::engine
