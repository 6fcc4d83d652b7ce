// SPDX-License-Identifier: MIT
//
// os_test: the kernel against the documented behaviour of uC/OS-II's calls.

#include "os_host.h"
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

extern "C" {
#include "ucos_ii.h"
}

namespace {

// Tasks write what they do here; the machine's idle passes one tick.
class Os : public ::testing::Test {
protected:
    void SetUp() override {
        OsHost::setMachine(
            {[this] { idle(); }, [this] { return tickPending_ || irq_; }, [this] { serve(); }});
        OSInit();
    }

    void task(INT8U priority, std::function<void()> body) {
        bodies_.push_back(std::make_unique<std::function<void()>>(std::move(body)));
        ASSERT_EQ(OSTaskCreate(runBody, bodies_.back().get(), stack_ + 15, priority), OS_ERR_NONE);
    }
    void say(const std::string& what) { log_ += what + " "; }
    void runUntilIdleFor(unsigned ticks) {
        limit_ = ticks;
        OsHost::run();
    }

    std::string log_;
    bool irq_ = false;
    std::function<void()> onIrq_;

private:
    static void runBody(void* body) {
        (*static_cast<std::function<void()>*>(body))();
        for (;;)
            OSTimeDly(1000000);
    }
    void idle() {
        if (++ticks_ > limit_)
            OsHost::stop();
        tickPending_ = true;
    }
    void serve() {
        if (tickPending_) {
            tickPending_ = false;
            OSTimeTick();
        }
        if (irq_) {
            irq_ = false;
            onIrq_();
        }
    }

    std::vector<std::unique_ptr<std::function<void()>>> bodies_;
    OS_STK stack_[16];
    bool tickPending_ = false;
    unsigned ticks_ = 0, limit_ = 0;
};

TEST_F(Os, HigherPriorityRunsFirstAndPreemptsOnPost) {
    OS_EVENT* sem = OSSemCreate(0);
    INT8U err = 0;
    task(5, [&] {
        say("high-waits");
        OSSemPend(sem, 0, &err);
        say("high-goes");
    });
    task(10, [&] {
        say("low-posts");
        OSSemPost(sem);
        say("low-ends");
    });
    runUntilIdleFor(3);
    EXPECT_EQ(log_, "high-waits low-posts high-goes low-ends ");
    EXPECT_EQ(err, OS_ERR_NONE);
}

TEST_F(Os, PendTimesOutAfterItsTicks) {
    OS_EVENT* sem = OSSemCreate(0);
    INT8U err = 0;
    INT32U took = 0;
    task(5, [&] {
        INT32U start = OSTimeGet();
        OSSemPend(sem, 7, &err);
        took = OSTimeGet() - start;
    });
    runUntilIdleFor(20);
    EXPECT_EQ(err, OS_ERR_TIMEOUT);
    EXPECT_EQ(took, 7u);
}

TEST_F(Os, SemaphoreCountsAndAcceptNeverBlocks) {
    OS_EVENT* sem = OSSemCreate(1);
    task(5, [&] {
        EXPECT_EQ(OSSemAccept(sem), 1u);
        EXPECT_EQ(OSSemAccept(sem), 0u);
        EXPECT_EQ(OSSemPost(sem), OS_ERR_NONE);
        EXPECT_EQ(OSSemAccept(sem), 1u);
        say("done");
    });
    runUntilIdleFor(2);
    EXPECT_EQ(log_, "done ");
}

TEST_F(Os, MutexOwnerInheritsTheCeilingWhileAHigherTaskWaits) {
    INT8U err = 0;
    OS_EVENT* mutex = OSMutexCreate(2, &err);
    ASSERT_EQ(err, OS_ERR_NONE);
    task(20, [&] {
        OSMutexPend(mutex, 0, &err);
        OSTimeDly(2); // high and middle start meanwhile
        say("low-works");
        OSMutexPost(mutex);
        say("low-ends");
    });
    task(5, [&] {
        OSTimeDly(1);
        say("high-wants");
        OSMutexPend(mutex, 0, &err);
        say("high-has");
        OSMutexPost(mutex);
    });
    task(10, [&] {
        OSTimeDly(2); // ready together with low: without inheritance it would run first
        say("middle");
    });
    runUntilIdleFor(10);
    EXPECT_EQ(log_, "high-wants low-works high-has middle low-ends ");
}

TEST_F(Os, MutexErrors) {
    INT8U err = 0;
    OS_EVENT* mutex = OSMutexCreate(2, &err);
    OSMutexCreate(2, &err);
    EXPECT_EQ(err, OS_ERR_PRIO_EXIST);
    EXPECT_EQ(OSTaskCreate([](void*) {}, nullptr, nullptr, 2), OS_ERR_PRIO_EXIST);
    task(5, [&] { OSMutexPend(mutex, 0, &err); });
    task(6, [&] {
        EXPECT_EQ(OSMutexPost(mutex), OS_ERR_NOT_MUTEX_OWNER);
        EXPECT_EQ(OSSemPost(mutex), OS_ERR_EVENT_TYPE);
        EXPECT_EQ(OSSemPost(nullptr), OS_ERR_PEVENT_NULL);
        say("checked");
    });
    runUntilIdleFor(2);
    EXPECT_EQ(log_, "checked ");
}

TEST_F(Os, QueueKeepsOrderAndReportsFull) {
    void* slots[2];
    OS_EVENT* queue = OSQCreate(slots, 2);
    int a = 0, b = 0, c = 0;
    INT8U err = 0;
    task(5, [&] {
        EXPECT_EQ(OSQPost(queue, &a), OS_ERR_NONE);
        EXPECT_EQ(OSQPost(queue, &b), OS_ERR_NONE);
        EXPECT_EQ(OSQPost(queue, &c), OS_ERR_Q_FULL);
        EXPECT_EQ(OSQPend(queue, 1, &err), &a);
        EXPECT_EQ(OSQPend(queue, 1, &err), &b);
        EXPECT_EQ(OSQPend(queue, 1, &err), nullptr);
        EXPECT_EQ(err, OS_ERR_TIMEOUT);
        say("done");
    });
    runUntilIdleFor(5);
    EXPECT_EQ(log_, "done ");
}

TEST_F(Os, InterruptWakesATaskAndPendInInterruptIsRefused) {
    OS_EVENT* sem = OSSemCreate(0);
    INT8U err = 0, irqErr = 0;
    onIrq_ = [&] {
        OSSemPend(sem, 0, &irqErr);
        OSSemPost(sem);
        say("irq");
    };
    task(5, [&] {
        OSSemPend(sem, 0, &err);
        say("task");
    });
    task(6, [&] {
        irq_ = true;
        OsHost::interruptPoint(); // where simulated time passes
        say("background");
    });
    runUntilIdleFor(2);
    EXPECT_EQ(log_, "irq task background ");
    EXPECT_EQ(irqErr, OS_ERR_PEND_ISR);
}

TEST_F(Os, CriticalSectionHoldsInterruptsBack) {
    onIrq_ = [&] { say("irq"); };
    task(5, [&] {
        OS_CPU_SR cpu_sr;
        OS_ENTER_CRITICAL();
        irq_ = true;
        OsHost::interruptPoint();
        say("critical");
        OS_EXIT_CRITICAL();
        OsHost::interruptPoint();
        say("after");
    });
    runUntilIdleFor(2);
    EXPECT_EQ(log_, "critical irq after ");
}

TEST_F(Os, LockedSchedulerDelaysTheSwitch) {
    OS_EVENT* sem = OSSemCreate(0);
    INT8U err = 0;
    task(5, [&] {
        OSSemPend(sem, 0, &err);
        say("high");
    });
    task(6, [&] {
        OSSchedLock();
        OSSemPost(sem);
        say("low");
        OSSchedUnlock();
        say("end");
    });
    runUntilIdleFor(2);
    EXPECT_EQ(log_, "low high end ");
}

TEST_F(Os, AnExceptionInATaskLeavesRun) {
    task(5, [&] { throw std::runtime_error("bus hung"); });
    EXPECT_THROW(runUntilIdleFor(2), std::runtime_error);
}

TEST_F(Os, PrioritiesAndTasksAreLimited) {
    EXPECT_EQ(OSTaskCreate([](void*) {}, nullptr, nullptr, OS_LOWEST_PRIO), OS_ERR_PRIO_INVALID);
    for (unsigned i = 0; i < OS_MAX_TASKS; ++i)
        task(static_cast<INT8U>(10 + i), [] {});
    EXPECT_EQ(OSTaskCreate([](void*) {}, nullptr, nullptr, 40), OS_ERR_TASK_NO_MORE_TCB);
    EXPECT_EQ(OSTaskCreate([](void*) {}, nullptr, nullptr, 10), OS_ERR_PRIO_EXIST);
}

} // namespace
