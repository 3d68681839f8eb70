// What contacts remember: slots of each grain, which begin with those in use, in the order in which a step met them. A slot
// has the key of what the grain touches: 1 + the id of a grain, less than zero for walls and obstacles, 0 where no slot
// follows. Each grain has a memory of its own of a contact, and both are alike.
#import common/vector
#import physics/dem/rotation
#import fields/contact_history
#if moves
#import fields/next_contact_history/write
#end

struct Memory {
    slide: Vector, // how far the surface of the other has slid over that of the grain, half a step ago, m
    roll: Rotation, // how far the other has rolled, half a step ago, rad
}

// Numbers of a grain's first slot in a buffer, and of all its slots.
fn first_word(grain: u32) -> u32 {
    return grain * CONTACT_SLOTS * CONTACT_WORDS;
}

// What the contact of this key remembers; nothing where it is new. `cursor` is where to look first: behind the slot that was
// found last, since most steps meet contacts in the same order.
fn recall(grain: u32, key: f32, cursor: ptr<function, u32>) -> Memory {
    let first = first_word(grain);
    let begin = *cursor;
    var slot = begin;
    for (var tried = 0u; tried < CONTACT_SLOTS; tried++) {
        if slot >= CONTACT_SLOTS {
            slot = 0u;
        }
        let word = contact_history[first + slot * CONTACT_WORDS];
        if word.w == key {
            *cursor = slot + 1u;
            var memory = Memory(unpack(word), Rotation());
#if two_dimensional
            memory.roll = word.z;
#else
#if rolling_spring
            memory.roll = contact_history[first + slot * CONTACT_WORDS + 1u].xyz;
#end
#end
            return memory;
        }
        slot = select(slot + 1u, 0u, word.w == 0.0);
        if slot == begin {
            break;
        }
    }
    return Memory();
}

#if moves
fn remember(grain: u32, slot: u32, key: f32, memory: Memory) {
    let word = first_word(grain) + slot * CONTACT_WORDS;
#if two_dimensional
    next_contact_history[word] = vec4f(memory.slide, memory.roll, key);
#else
    next_contact_history[word] = vec4f(memory.slide, key);
#if rolling_spring
    next_contact_history[word + 1u] = vec4f(memory.roll, 0.0);
#end
#end
}

// Behind the last slot in use.
fn end_slots(grain: u32, slots: u32) {
    if slots < CONTACT_SLOTS {
        next_contact_history[first_word(grain) + slots * CONTACT_WORDS] = vec4f(0.0);
    }
}
#end
