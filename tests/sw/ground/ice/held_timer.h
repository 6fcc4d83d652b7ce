// SPDX-License-Identifier: MIT
//
// held_timer: stops the timer thread of an Ice communicator immediately before it runs a task, so
// that a test decides what happens first. Ice informs the observer of its threads about this
// moment.

#pragma once

#include <Ice/Ice.h>
#include <condition_variable>
#include <memory>
#include <mutex>

class HeldTimer {
    struct State {
        std::mutex mutex;
        std::condition_variable changed;
        bool holds = false, isHeld = false;
        int threads = 0; // running threads of thread pools

        template <class Change> void change(Change made) {
            std::lock_guard<std::mutex> lock(mutex);
            made();
            changed.notify_all();
        }
        template <class Is> void wait(Is is) {
            std::unique_lock<std::mutex> lock(mutex);
            changed.wait(lock, is);
        }
    };

    struct ThreadObserver : Ice::Instrumentation::ThreadObserver {
        explicit ThreadObserver(State& s) : state(s) {}
        void attach() override {}
        void detach() override {}
        void failed(const std::string&) override {}
        void stateChanged(Ice::Instrumentation::ThreadState,
                          Ice::Instrumentation::ThreadState next) override {
            if (next == Ice::Instrumentation::ThreadState::ThreadStateIdle)
                return;
            state.change([this] { state.isHeld = state.holds; });
            state.wait([this] { return !state.holds; });
        }
        State& state;
    };

    struct Observer : Ice::Instrumentation::CommunicatorObserver {
        explicit Observer(State& s) : state(s) {}
        std::shared_ptr<Ice::Instrumentation::ThreadObserver>
        getThreadObserver(const std::string&, const std::string& id,
                          Ice::Instrumentation::ThreadState,
                          const std::shared_ptr<Ice::Instrumentation::ThreadObserver>&) override {
            return id == "Ice.Timer" ? std::make_shared<ThreadObserver>(state) : nullptr;
        }
        void setObserverUpdater(
            const std::shared_ptr<Ice::Instrumentation::ObserverUpdater>& u) override {
            updater = u;
        }
        std::shared_ptr<Ice::Instrumentation::Observer>
        getConnectionEstablishmentObserver(const std::shared_ptr<Ice::Endpoint>&,
                                           const std::string&) override {
            return nullptr;
        }
        std::shared_ptr<Ice::Instrumentation::Observer>
        getEndpointLookupObserver(const std::shared_ptr<Ice::Endpoint>&) override {
            return nullptr;
        }
        std::shared_ptr<Ice::Instrumentation::ConnectionObserver> getConnectionObserver(
            const std::shared_ptr<Ice::ConnectionInfo>&, const std::shared_ptr<Ice::Endpoint>&,
            Ice::Instrumentation::ConnectionState,
            const std::shared_ptr<Ice::Instrumentation::ConnectionObserver>&) override {
            return nullptr;
        }
        std::shared_ptr<Ice::Instrumentation::InvocationObserver>
        getInvocationObserver(const std::shared_ptr<Ice::ObjectPrx>&, const std::string&,
                              const Ice::Context&) override {
            return nullptr;
        }
        std::shared_ptr<Ice::Instrumentation::DispatchObserver>
        getDispatchObserver(const Ice::Current&, int) override {
            return nullptr;
        }
        State& state;
        std::shared_ptr<Ice::Instrumentation::ObserverUpdater> updater;
    };

public:
    // Returns the data with which the communicator must be initialized.
    Ice::InitializationData data() {
        Ice::InitializationData data;
        data.observer = observer_;
        data.threadStart = [this] { state_.change([this] { ++state_.threads; }); };
        data.threadStop = [this] { state_.change([this] { --state_.threads; }); };
        return data;
    }
    // Makes the timer thread wait before its next task, until release().
    void hold() {
        state_.change([this] { state_.holds = true; });
        observer_->updater->updateThreadObservers(); // Ice observes its timer only after this call
    }
    void release() {
        state_.change([this] { state_.holds = false; });
    }
    void waitUntilHeld() {
        state_.wait([this] { return state_.isHeld; });
    }
    void waitUntilPoolsHaveEnded() {
        state_.wait([this] { return state_.threads == 0; });
    }

private:
    State state_;
    const std::shared_ptr<Observer> observer_ = std::make_shared<Observer>(state_);
};
