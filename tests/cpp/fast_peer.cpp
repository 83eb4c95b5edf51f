// A DDS program on Fast DDS, the layer below rmw_fastrtps, told what to do by one JSON object per line on standard
// input.
//
// It answers as tests/python/peer.py does, to as much as the tests ask of it: subscribe, take, listen (one topic),
// publish (Float64), call (with a request of zeros; it tells how long the reply is and whether it begins with true), matched,
// quit. Of a message
// it decodes, with Fast CDR, the header and, of TwinStatus, the fields behind it. Nothing of the Rust code is used.
// FAST_KEYS names the folder of an enclave of SROS2 that it is to use.

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;
using Clock = std::chrono::steady_clock;
using Payload = std::vector<char>;

// Bytes with their CDR header, whatever the type: what goes over the wire.
class RawType : public TopicDataType {
public:
    explicit RawType(const std::string& name) {
        setName(name.c_str());
        m_typeSize = 1 << 17;
        m_isGetKeyDefined = false;
    }
    bool serialize(void* data, SerializedPayload_t* payload) override {
        const auto& bytes = *static_cast<Payload*>(data);
        if (bytes.size() > payload->max_size) return false;
        std::memcpy(payload->data, bytes.data(), bytes.size());
        payload->length = static_cast<uint32_t>(bytes.size());
        payload->encapsulation = CDR_LE;
        return true;
    }
    bool deserialize(SerializedPayload_t* payload, void* data) override {
        const char* begin = reinterpret_cast<const char*>(payload->data);
        static_cast<Payload*>(data)->assign(begin, begin + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return static_cast<uint32_t>(static_cast<Payload*>(data)->size()); };
    }
    void* createData() override { return new Payload(); }
    void deleteData(void* data) override { delete static_cast<Payload*>(data); }
    bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

// The text behind a key of a flat JSON object; serde_json puts no space behind the colon.
std::string text(const std::string& line, const std::string& key) {
    const auto at = line.find("\"" + key + "\":");
    if (at == std::string::npos) return "";
    const auto begin = line.find('"', at + key.size() + 3) + 1;
    return line.substr(begin, line.find('"', begin) - begin);
}

double number(const std::string& line, const std::string& key, double otherwise) {
    const auto at = line.find("\"" + key + "\":");
    return at == std::string::npos ? otherwise : std::stod(line.substr(at + key.size() + 3));
}

int64_t wall() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

struct Message {
    int32_t sec = 0;
    uint32_t nanosec = 0;
    std::string frame_id;
    uint64_t sequence = 0;
    uint8_t state = 0;
    double model_time = 0;
};

Message decode(Payload& bytes, bool is_status) {
    eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::Cdr::DDS_CDR);
    cdr.read_encapsulation();
    Message message;
    cdr >> message.sec >> message.nanosec >> message.frame_id;
    if (is_status) cdr >> message.sequence >> message.state >> message.model_time;
    return message;
}

class Peer {
public:
    explicit Peer(int domain) {
        participant_ = DomainParticipantFactory::get_instance()->create_participant(domain, secured(PARTICIPANT_QOS_DEFAULT));
        if (participant_ == nullptr) throw std::runtime_error("no participant");
        publisher_ = participant_->create_publisher(PUBLISHER_QOS_DEFAULT);
        subscriber_ = participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
    }

    std::string run(const std::string& line) {
        const auto what = text(line, "do"), topic = text(line, "topic");
        if (what == "subscribe") return subscribe(topic, text(line, "type"), text(line, "kind"));
        if (what == "publish") return publish(topic, text(line, "type"), number(line, "data", 0));
        if (what == "take") return take(topic, number(line, "seconds", 0), number(line, "count", 1));
        if (what == "call") {
            return call(text(line, "service"), text(line, "type"), static_cast<size_t>(number(line, "zeros", 4)));
        }
        if (what == "matched") {
            SubscriptionMatchedStatus status;
            reader(topic)->get_subscription_matched_status(status);
            return "{\"matched\": " + std::to_string(status.current_count) + "}";
        }
        if (what == "listen") {
            const auto begin = line.find('"', line.find('[')) + 1;
            return listen(line.substr(begin, line.find('"', begin) - begin), number(line, "seconds", 1));
        }
        throw std::runtime_error("no command " + what);
    }

private:
    // With the keys of an enclave of SROS2, if there are any.
    static DomainParticipantQos secured(DomainParticipantQos qos) {
        const char* folder = std::getenv("FAST_KEYS");
        if (folder == nullptr) return qos;
        auto& properties = qos.properties().properties();
        const std::string at = std::string("file://") + folder + "/", auth = "dds.sec.auth.builtin.PKI-DH.",
                          access = "dds.sec.access.builtin.Access-Permissions.";
        properties.emplace_back("dds.sec.auth.plugin", "builtin.PKI-DH");
        properties.emplace_back(auth + "identity_ca", at + "identity_ca.cert.pem");
        properties.emplace_back(auth + "identity_certificate", at + "cert.pem");
        properties.emplace_back(auth + "private_key", at + "key.pem");
        properties.emplace_back("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
        properties.emplace_back("dds.sec.access.plugin", "builtin.Access-Permissions");
        properties.emplace_back(access + "permissions_ca", at + "permissions_ca.cert.pem");
        properties.emplace_back(access + "governance", at + "governance.p7s");
        properties.emplace_back(access + "permissions", at + "permissions.p7s");
        return qos;
    }

    // The ROS 2 names on the wire: std_msgs/msg/Float64 is std_msgs::msg::dds_::Float64_.
    static std::string dds_type(const std::string& type) {
        const auto first = type.find('/'), last = type.rfind('/');
        const auto package = type.substr(0, first), kind = type.substr(first + 1, last - first - 1);
        return package + "::" + kind + "::dds_::" + type.substr(last + 1) + "_";
    }

    Topic* dds_topic(const std::string& dds_name, const std::string& type) {
        if (topics_.count(dds_name)) return topics_[dds_name];
        const auto dds = dds_type(type);
        TypeSupport(new RawType(dds)).register_type(participant_);
        return topics_[dds_name] = participant_->create_topic(dds_name, dds, TOPIC_QOS_DEFAULT);
    }

    // /a/b is rt/a/b.
    Topic* topic_of(const std::string& name, const std::string& type) {
        is_status_[name] = type == "flexdrill/msg/TwinStatus";
        return dds_topic("rt" + name, type);
    }

    struct Client {
        DataWriter* requests;
        DataReader* replies;
    };

    // Asks as rmw_fastrtps does: the request's identity is that of its sample, and a reply that names another is not taken.
    std::string call(const std::string& service, const std::string& type, size_t zeros) {
        auto& client = clients_[service];
        if (client.requests == nullptr) {
            DataWriterQos writing = DATAWRITER_QOS_DEFAULT;
            writing.reliability().kind = RELIABLE_RELIABILITY_QOS;
            writing.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
            client.requests =
                publisher_->create_datawriter(dds_topic("rq" + service + "Request", type + "_Request"), writing);
            DataReaderQos reading = DATAREADER_QOS_DEFAULT;
            reading.reliability().kind = RELIABLE_RELIABILITY_QOS;
            reading.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
            client.replies =
                subscriber_->create_datareader(dds_topic("rr" + service + "Reply", type + "_Response"), reading);
            if (client.requests == nullptr || client.replies == nullptr) throw std::runtime_error("no client");
        }
        const auto deadline = Clock::now() + std::chrono::seconds(15);
        const auto pause = std::chrono::milliseconds(10);
        PublicationMatchedStatus server;
        SubscriptionMatchedStatus back;
        do {
            std::this_thread::sleep_for(pause);
            client.requests->get_publication_matched_status(server);
            client.replies->get_subscription_matched_status(back);
        } while ((server.current_count == 0 || back.current_count == 0) && Clock::now() < deadline);
        Payload request(4 + zeros, 0);
        request[1] = 1;
        eprosima::fastrtps::rtps::WriteParams asked;
        if (!client.requests->write(&request, asked)) throw std::runtime_error("the request was not written");
        Payload reply;
        SampleInfo info;
        while (Clock::now() < deadline) {
            while (client.replies->take_next_sample(&reply, &info) == ReturnCode_t::RETCODE_OK) {
                if (!info.valid_data || reply.size() < 5) continue;
                const auto& answered = info.related_sample_identity.sequence_number();
                if (answered != asked.sample_identity().sequence_number()) continue;
                return std::string("{\"reply\": {\"success\": ") + (reply[4] ? "true" : "false") +
                       ", \"bytes\": " + std::to_string(reply.size()) + "}}";
            }
            std::this_thread::sleep_for(pause);
        }
        throw std::runtime_error("no reply");
    }

    std::string subscribe(const std::string& name, const std::string& type, const std::string& kind) {
        DataReaderQos qos = DATAREADER_QOS_DEFAULT;
        qos.reliability().kind = kind == "best_effort" ? BEST_EFFORT_RELIABILITY_QOS : RELIABLE_RELIABILITY_QOS;
        qos.durability().kind = kind == "latched" ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
        qos.history().depth = 50;
        if (kind == "hoarding") {
            qos.history().kind = KEEP_ALL_HISTORY_QOS;
            qos.resource_limits().max_samples = qos.resource_limits().max_samples_per_instance = 5;
            qos.resource_limits().max_instances = 1;
            qos.resource_limits().allocated_samples = 5;
        }
        qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
        auto* made = subscriber_->create_datareader(topic_of(name, type), qos);
        if (made == nullptr) throw std::runtime_error("no reader");
        readers_[name] = made;
        std::ostringstream id;
        const auto& guid = made->guid();
        char byte[3];
        for (auto value : guid.guidPrefix.value) id << (std::snprintf(byte, 3, "%02x", value), byte);
        for (auto value : guid.entityId.value) id << (std::snprintf(byte, 3, "%02x", value), byte);
        return "{\"id\": \"" + id.str() + "\"}";
    }

    DataReader* reader(const std::string& name) {
        if (!readers_.count(name)) throw std::runtime_error("not subscribed to " + name);
        return readers_[name];
    }

    std::string publish(const std::string& name, const std::string& type, double value) {
        auto& writer = writers_[name];
        const bool is_new = writer == nullptr;
        if (is_new) {
            DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
            qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
            qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
            writer = publisher_->create_datawriter(topic_of(name, type), qos);
            if (writer == nullptr) throw std::runtime_error("no writer");
        }
        PublicationMatchedStatus status;
        const auto deadline = Clock::now() + std::chrono::seconds(10);
        do {
            writer->get_publication_matched_status(status);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        } while (status.current_count == 0 && Clock::now() < deadline);
        // The other side may learn of this writer a moment later, and it reads best effort.
        if (is_new) std::this_thread::sleep_for(std::chrono::milliseconds(500));
        Payload bytes{0, 1, 0, 0};
        bytes.resize(12);
        std::memcpy(bytes.data() + 4, &value, 8);
        if (!writer->write(&bytes)) throw std::runtime_error("not written");
        return "{\"matched\": " + std::to_string(status.current_count) + "}";
    }

    bool next(const std::string& name, Message& message) {
        Payload bytes;
        SampleInfo info;
        while (reader(name)->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
            // That a writer has gone comes as a sample without data.
            if (!info.valid_data) continue;
            message = decode(bytes, is_status_[name]);
            return true;
        }
        return false;
    }

    std::string take(const std::string& name, double seconds, double count) {
        std::ostringstream found;
        int taken = 0;
        const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
        Message message;
        while (true) {
            while (next(name, message)) {
                found << (taken++ ? ", " : "") << "{\"header\": {\"stamp\": {\"sec\": " << message.sec << ", \"nanosec\": "
                      << message.nanosec << "}, \"frame_id\": \"" << message.frame_id << "\"}, \"sequence\": "
                      << message.sequence << ", \"state\": " << int(message.state) << ", \"model_time\": "
                      << message.model_time << "}";
            }
            if (taken >= count || Clock::now() >= deadline) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return "{\"messages\": [" + found.str() + "]}";
    }

    std::string listen(const std::string& name, double seconds) {
        std::ostringstream found;
        Message message;
        while (next(name, message)) {
        }
        bool is_first = true;
        const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
        while (Clock::now() < deadline) {
            while (next(name, message)) {
                const int64_t stamp = int64_t(message.sec) * 1000000000 + message.nanosec;
                found << (is_first ? "" : ", ") << "[" << stamp << ", 0, " << wall() << "]";
                is_first = false;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return "{\"received\": {\"" + name + "\": [" + found.str() + "]}}";
    }

    DomainParticipant* participant_;
    Publisher* publisher_;
    Subscriber* subscriber_;
    std::map<std::string, Topic*> topics_;
    std::map<std::string, bool> is_status_;
    std::map<std::string, DataReader*> readers_;
    std::map<std::string, DataWriter*> writers_;
    std::map<std::string, Client> clients_;
};

int main(int count, char** arguments) {
    Peer peer(count > 1 ? std::stoi(arguments[1]) : 0);
    std::cout << "{\"ready\": true}" << std::endl;
    for (std::string line; std::getline(std::cin, line) && text(line, "do") != "quit";) {
        try {
            std::cout << peer.run(line) << std::endl;
        } catch (const std::exception& error) {  // told to the test, which fails on it
            std::cout << "{\"error\": \"" << error.what() << "\"}" << std::endl;
        }
    }
    // The library's own threads are not waited for.
    std::_Exit(0);
}
